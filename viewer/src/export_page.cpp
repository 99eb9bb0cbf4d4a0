#include "pent/viewer/export_page.h"

#include "http.h"
#include "web_page.h"

#include <pent/base64.h>
#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/obstacles_file.h>
#include <pent/output_file.h>
#include <pent/run_files.h>
#include <pent/viewer/attributes.h>
#include <pent/viewer/coloring.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <string_view>

namespace pent::viewer {

namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr int kSteps = 65535;     // of a coordinate
constexpr int kColorSteps = 255;  // of a quantity
constexpr std::array<ColorBy::Kind, 3> kQuantities = {ColorBy::Speed, ColorBy::Strain,
                                                      ColorBy::Force};

// The vertices of a body that its boundary has, and their new numbers.
struct Shell {
    std::vector<std::uint32_t> vertices;
    std::vector<std::uint32_t> facets;  // four numbers each; of a triangle the last is 0
};

template <int Dim>
Shell shell_of(const Body<Dim>& body) {
    Shell shell;
    std::vector<std::uint32_t> number(static_cast<std::size_t>(body.mesh.vertex_count()), kNone);
    for (const std::uint32_t vertex : body.boundary.facets.reshaped()) {
        number[vertex] = 0;
    }
    for (std::uint32_t vertex = 0; vertex < number.size(); ++vertex) {
        if (number[vertex] == 0) {
            number[vertex] = static_cast<std::uint32_t>(shell.vertices.size());
            shell.vertices.push_back(vertex);
        }
    }
    for (const auto& facet : body.boundary.facets.colwise()) {
        for (int k = 0; k < 4; ++k) {
            shell.facets.push_back(k < Dim ? number[facet[k]] : 0);
        }
    }
    return shell;
}

std::string data_element(const std::string& id, std::string_view bytes) {
    return "<script type=\"text/plain\" id=\"" + id + "\">" + to_base64(bytes) + "</script>\n";
}

std::string numbers(const Eigen::VectorXd& values) {
    std::string text = "[";
    for (Eigen::Index i = 0; i < values.size(); ++i) {
        text += formatted("%s%.17g", i == 0 ? "" : ",", values[i]);
    }
    return text + "]";
}

template <int Dim>
class Exporter {
public:
    Exporter(const RunFolder& run, const ExportOptions& options)
        : run_(run), options_(options), bodies_(load_bodies<Dim>(run)) {
        for (const Body<Dim>& body : bodies_) {
            shells_.push_back(shell_of<Dim>(body));
        }
        const Frame<Dim> first = load_frame<Dim>(run, bodies_.front(), options.frames.front());
        for (const ColorBy::Kind by : kQuantities) {
            const bool is_there = by == ColorBy::Speed   ? first.velocities.cols() > 0
                                  : by == ColorBy::Force ? !lacks(first, by)
                                                         : !run.is_mesh;
            if (is_there) {
                quantities_.push_back(by);
            }
        }
        maxima_.resize(quantities_.size());
    }

    void check_size(const std::filesystem::path& output, std::int64_t page_bytes) const {
        constexpr std::int64_t kAround = 100;  // of text
        const bool do_move = std::filesystem::is_directory(run_.path / kObstaclesFolder);
        const std::int64_t obstacles = std::max(obstacle_bytes(options_.frames.front()),
                                                obstacle_bytes(options_.frames.back()));
        std::int64_t a_frame = kAround + (do_move ? obstacles : 0);
        std::int64_t once = page_bytes + 1000 + (do_move ? 0 : obstacles);
        for (const Shell& shell : shells_) {
            const auto vertices = static_cast<std::int64_t>(shell.vertices.size());
            const auto quantities = static_cast<std::int64_t>(quantities_.size());
            a_frame += vertices * (2 * Dim + quantities) * 4 / 3;
            once += static_cast<std::int64_t>(shell.facets.size()) * 4 * 4 / 3;
        }
        const auto count = static_cast<std::int64_t>(options_.frames.size());
        const std::int64_t bytes = once + count * a_frame;
        if (bytes > options_.most_bytes) {
            const auto mb = [](std::int64_t size) { return static_cast<double>(size) / 1e6; };
            const std::int64_t room = (options_.most_bytes - once) / a_frame;
            throw Error(output.string()
                        + formatted(": would have %.1f MB, expected at most %.1f; ", mb(bytes),
                                    mb(options_.most_bytes))
                        + (room > 0 ? "take fewer frames, as with --frames ::"
                                          + std::to_string((count + room - 1) / room) + ", or "
                                    : std::string())
                        + "raise --limit");
        }
    }

    // What coordinates and quantities range over.
    void look_at(int frame) {
        for (const Body<Dim>& body : bodies_) {
            const Frame<Dim> moment = load_frame<Dim>(run_, body, frame);
            for (const auto& point : moment.positions.colwise()) {
                box_.extend(point);
            }
            times_.resize(std::max(times_.size(), frames_seen_ + 1));
            times_[frames_seen_] = moment.time;
            for (std::size_t i = 0; i < quantities_.size(); ++i) {
                maxima_[i] = std::max(maxima_[i],
                                      vertex_values<Dim>(body, moment, quantities_[i]).maxCoeff());
            }
        }
        obstacles_.push_back(load_obstacles<Dim>(run_, frame));
        ++frames_seen_;
    }

    [[nodiscard]] std::string description(const std::string& title) const {
        std::string text = "<script type=\"application/json\" id=\"pent-run\">{\"version\":1,";
        text += "\"title\":" + json_string(title) + ",\"dimension\":" + std::to_string(Dim)
                + ",\"low\":" + numbers(box_.min()) + ",\"high\":" + numbers(box_.max())
                + ",\"maxima\":{\"speed\":" + maximum(ColorBy::Speed)
                + ",\"strain\":" + maximum(ColorBy::Strain)
                + ",\"force\":" + maximum(ColorBy::Force) + "},\"bodies\":[";
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            text += (i == 0 ? "{\"name\":" : ",{\"name\":") + json_string(bodies_[i].name)
                    + ",\"vertices\":" + std::to_string(shells_[i].vertices.size())
                    + ",\"cells\":" + std::to_string(bodies_[i].mesh.cell_count())
                    + ",\"facets\":" + std::to_string(shells_[i].facets.size() / 4) + "}";
        }
        text += "],\"frames\":[";
        for (std::size_t i = 0; i < options_.frames.size(); ++i) {
            text += formatted("%s{\"frame\":%d,\"time\":%.17g}", i == 0 ? "" : ",",
                              options_.frames[i], times_[i]);
        }
        return text + "],\"obstacles\":[" + obstacles() + "]}</script>\n";
    }

    [[nodiscard]] std::string facets() const {
        std::string bytes;
        for (const Shell& shell : shells_) {
            bytes.append(reinterpret_cast<const char*>(shell.facets.data()),
                         shell.facets.size() * sizeof(std::uint32_t));
        }
        return data_element("pent-facets", bytes);
    }

    [[nodiscard]] std::string frame(std::size_t place) const {
        std::string bytes;
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            const Frame<Dim> moment = load_frame<Dim>(run_, bodies_[i], options_.frames[place]);
            append_positions(bytes, moment.positions, shells_[i]);
            for (std::size_t k = 0; k < quantities_.size(); ++k) {
                const Eigen::VectorXd values =
                    vertex_values<Dim>(bodies_[i], moment, quantities_[k]);
                const double scale = maxima_[k] > 0 ? kColorSteps / maxima_[k] : 0;
                for (const std::uint32_t vertex : shells_[i].vertices) {
                    bytes += static_cast<char>(std::lround(values[vertex] * scale));
                }
            }
        }
        return data_element("pent-frame-" + std::to_string(place), bytes);
    }

    [[nodiscard]] double largest_error() const { return box_.sizes().maxCoeff() / kSteps / 2; }

private:
    [[nodiscard]] std::int64_t obstacle_bytes(int frame) const {
        const std::vector<ObstacleShape<Dim>> list = load_obstacles<Dim>(run_, frame);
        return list.empty() ? 0 : static_cast<std::int64_t>(obstacles_text<Dim>(list).size());
    }

    [[nodiscard]] std::string maximum(const ColorBy& by) const {
        const auto found = std::find(quantities_.begin(), quantities_.end(), by);
        return found == quantities_.end()
                   ? "null"
                   : formatted("%.9g",
                               maxima_[static_cast<std::size_t>(found - quantities_.begin())]);
    }

    void append_positions(std::string& bytes,
                          const Positions<Dim>& positions,
                          const Shell& shell) const {
        for (const std::uint32_t vertex : shell.vertices) {
            for (int axis = 0; axis < Dim; ++axis) {
                const double low = box_.min()[axis];
                const double size = box_.max()[axis] - low;
                const double place = size > 0 ? (positions(axis, vertex) - low) / size : 0;
                const auto step = static_cast<std::uint16_t>(std::lround(place * kSteps));
                bytes += static_cast<char>(step & 255);
                bytes += static_cast<char>(step >> 8);
            }
        }
    }

    // Files of obstacles, one for each frame, one where none of them moves, none where there are
    // none.
    [[nodiscard]] std::string obstacles() const {
        std::vector<std::string> texts;
        for (const std::vector<ObstacleShape<Dim>>& list : obstacles_) {
            texts.push_back(obstacles_text<Dim>(list));
        }
        if (std::adjacent_find(texts.begin(), texts.end(), std::not_equal_to<>()) == texts.end()) {
            texts.resize(obstacles_.front().empty() ? 0 : 1);
        }
        std::string text;
        for (const std::string& one : texts) {
            text += (text.empty() ? "" : ",") + one;
        }
        return text;
    }

    const RunFolder& run_;
    const ExportOptions& options_;
    std::vector<Body<Dim>> bodies_;
    std::vector<Shell> shells_;
    std::vector<ColorBy> quantities_;
    std::vector<double> maxima_;
    std::vector<double> times_;
    std::vector<std::vector<ObstacleShape<Dim>>> obstacles_;  // of each frame
    std::size_t frames_seen_ = 0;
    Eigen::AlignedBox<double, Dim> box_;
};

template <int Dim>
ExportReport export_as(const RunFolder& run,
                       const std::filesystem::path& output,
                       const ExportOptions& options,
                       const OnProgress& on_progress) {
    const std::string page = read_web_page(options.page);
    Exporter<Dim> exporter(run, options);
    exporter.check_size(output, static_cast<std::int64_t>(page.size()));
    OutputFile file(output);
    const auto total = static_cast<std::int64_t>(options.frames.size());
    ExportReport report;
    for (std::int64_t i = 0; i < total; ++i) {
        if (!on_progress("looked at frame", i, total)) {
            return report;
        }
        exporter.look_at(options.frames[static_cast<std::size_t>(i)]);
    }
    (void)on_progress("looked at frame", total, total);
    const auto put = [&](std::string_view text) {
        file.write(text);
        report.bytes += static_cast<std::int64_t>(text.size());
    };
    const std::size_t mark = page.find(kRunMark);
    put(std::string_view(page).substr(0, mark));
    const auto name = std::filesystem::weakly_canonical(run.path);
    put(exporter.description((run.is_mesh ? name.stem() : name.filename()).string()));
    put(exporter.facets());
    for (std::int64_t i = 0; i < total; ++i) {
        if (!on_progress("wrote frame", i, total)) {
            return report;
        }
        put(exporter.frame(static_cast<std::size_t>(i)));
    }
    (void)on_progress("wrote frame", total, total);
    put(std::string_view(page).substr(mark + kRunMark.size()));
    file.commit();
    report.largest_error = exporter.largest_error();
    report.is_complete = true;
    return report;
}

}  // namespace

ExportReport export_page(const RunFolder& run,
                         const std::filesystem::path& output,
                         const ExportOptions& options,
                         const OnProgress& on_progress) {
    return run.dimension == 4 ? export_as<4>(run, output, options, on_progress)
                              : export_as<3>(run, output, options, on_progress);
}

}  // namespace pent::viewer
