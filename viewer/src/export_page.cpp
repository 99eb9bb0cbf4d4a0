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

/// What the bodies can be colored by, and over what its steps go.
struct Quantity {
    ColorBy by;
    ColorRange range = {std::numeric_limits<double>::infinity(),
                        -std::numeric_limits<double>::infinity()};
};

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
        for (const Body<Dim>& body : bodies_) {
            first_.push_back(load_frame<Dim>(run, body, options.frames.front()));
        }
        std::vector<ColorBy> all = all_colorings();
        const std::vector<ColorBy> fields = field_colorings(bodies_.front(), first_.front());
        all.insert(all.end(), fields.begin(), fields.end());
        for (const ColorBy& by : all) {
            if (by != ColorBy::Body && by != ColorBy::W && have(by)) {
                (is_of_meshes(by) ? fields_ : quantities_).push_back({by});
            }
        }
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            widen(fields_, bodies_[i], first_[i]);
        }
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
            const auto fields = static_cast<std::int64_t>(fields_.size());
            once +=
                (static_cast<std::int64_t>(shell.facets.size()) * 4 + vertices * fields) * 4 / 3;
        }
        for (const std::vector<Quantity>* list : {&quantities_, &fields_}) {
            for (const Quantity& one : *list) {
                once += kAround + static_cast<std::int64_t>(name_of(one.by).size());
            }
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
            widen(quantities_, body, moment);
        }
        obstacles_.push_back(load_obstacles<Dim>(run_, frame));
        ++frames_seen_;
    }

    [[nodiscard]] std::string description(const std::string& title) const {
        std::string text = "<script type=\"application/json\" id=\"pent-run\">{\"version\":2,";
        text += "\"title\":" + json_string(title) + ",\"dimension\":" + std::to_string(Dim)
                + ",\"low\":" + numbers(box_.min()) + ",\"high\":" + numbers(box_.max())
                + ",\"quantities\":" + ranges(quantities_) + ",\"fields\":" + ranges(fields_)
                + ",\"bodies\":[";
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
        std::string values;
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            append_values(values, fields_, i, first_[i]);
        }
        return data_element("pent-facets", bytes) + data_element("pent-fields", values);
    }

    [[nodiscard]] std::string frame(std::size_t place) const {
        std::string bytes;
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            const Frame<Dim> moment = load_frame<Dim>(run_, bodies_[i], options_.frames[place]);
            append_positions(bytes, moment.positions, shells_[i]);
            append_values(bytes, quantities_, i, moment);
        }
        return data_element("pent-frame-" + std::to_string(place), bytes);
    }

    [[nodiscard]] double largest_error() const { return box_.sizes().maxCoeff() / kSteps / 2; }

private:
    [[nodiscard]] std::int64_t obstacle_bytes(int frame) const {
        const std::vector<ObstacleShape<Dim>> list = load_obstacles<Dim>(run_, frame);
        return list.empty() ? 0 : static_cast<std::int64_t>(obstacles_text<Dim>(list).size());
    }

    // Whether all bodies have it, which no mesh has of speed and strain.
    [[nodiscard]] bool have(const ColorBy& by) const {
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            const std::vector<ColorBy> fields = field_colorings(bodies_[i], first_[i]);
            const bool is_there = by == ColorBy::Speed    ? first_[i].velocities.cols() > 0
                                  : by == ColorBy::Strain ? !run_.is_mesh
                                  : by.kind == ColorBy::Field
                                      ? std::count(fields.begin(), fields.end(), by) > 0
                                      : !lacks(bodies_[i], first_[i], by);
            if (!is_there) {
                return false;
            }
        }
        return true;
    }

    [[nodiscard]] bool is_of_meshes(const ColorBy& by) const {
        return by != ColorBy::Speed && by != ColorBy::Strain && by != ColorBy::Force
               && std::all_of(first_.begin(), first_.end(), [&](const Frame<Dim>& frame) {
                      return find_field(frame, name_of(by)) == nullptr;
                  });
    }

    static void widen(std::vector<Quantity>& quantities,
                      const Body<Dim>& body,
                      const Frame<Dim>& moment) {
        for (Quantity& one : quantities) {
            const Eigen::VectorXd values = vertex_values<Dim>(body, moment, one.by);
            one.range = joined(one.range, {values.minCoeff(), values.maxCoeff()});
        }
    }

    [[nodiscard]] static std::string ranges(const std::vector<Quantity>& quantities) {
        std::string text = "[";
        for (const auto& [by, range] : quantities) {
            text += (text.size() > 1 ? ",{\"name\":" : "{\"name\":") + json_string(name_of(by))
                    + formatted(",\"low\":%.9g,\"high\":%.9g}", range.low, range.high);
        }
        return text + "]";
    }

    void append_values(std::string& bytes,
                       const std::vector<Quantity>& quantities,
                       std::size_t body,
                       const Frame<Dim>& moment) const {
        for (const auto& [by, range] : quantities) {
            const Eigen::VectorXd values = vertex_values<Dim>(bodies_[body], moment, by);
            for (const std::uint32_t vertex : shells_[body].vertices) {
                bytes +=
                    static_cast<char>(std::lround(range.place(values[vertex], by) * kColorSteps));
            }
        }
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
    std::vector<Frame<Dim>> first_;     // of each body
    std::vector<Quantity> quantities_;  // of frames
    std::vector<Quantity> fields_;      // of meshes, the same in all frames
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
