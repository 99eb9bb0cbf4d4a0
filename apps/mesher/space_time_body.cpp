// SPDX-License-Identifier: GPL-3.0-or-later

#include "space_time_body.h"

#include "common/heartbeat.h"
#include "expected_size.h"
#include "mesh_text.h"
#include "watchdog.h"

#include <pent/counted.h>
#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/input_path.h>
#include <pent/output_file.h>
#include <pent/pent_file.h>

#include <cmath>
#include <filesystem>
#include <system_error>
#include <unistd.h>
#include <utility>
#include <vector>

namespace pent::apps {

namespace {

namespace fs = std::filesystem;

using mesher::MovingMesh;
using mesher::SpaceTimeBody;
using Long = long long;  // NOLINT(google-runtime-int): printf's type

struct Made {
    SpaceTimeBody body;
    std::string cut;       // see MovingMesh
    std::string left_out;  // the same
    std::int64_t curved_cells = 0;
    std::size_t frames = 0;
    double from = 0;  // s
    double to = 0;    // s
};

Made make(Program& program, const MeshArguments& arguments, Heartbeat& heartbeat) {
    const Watchdog watchdog(program, arguments.time_limit);
    heartbeat.begin("read");
    MovingMesh moving = mesher::read_moving_mesh(arguments.input, arguments.space_time.series);
    Made made{{},
              moving.cut,
              moving.left_out,
              moving.curved_cells,
              moving.frame_count(),
              moving.times.front(),
              moving.times.back()};
    mesher::SpaceTimeOptions options = arguments.space_time.options;
    options.on_stage = [&](const std::string& stage) { heartbeat.begin(stage); };
    options.on_size = [&](double pentachora) {
        constexpr double kSeconds = 1e-6;  // to make, prove and measure a cell on one core
        ask_about_size(program, arguments.yes,
                       {.cells = pentachora, .seconds = kSeconds * pentachora}, 4);
    };
    made.body = mesher::make_space_time(std::move(moving), options);
    for (Eigen::Index axis = 0; axis < arguments.request.translation.size(); ++axis) {
        made.body.mesh.positions.row(axis).array() += arguments.request.translation[axis];
    }
    return made;
}

fs::path slab_path(const fs::path& output, std::size_t slab) {
    fs::path path = output;
    return path.replace_filename(frame_file_name(output.stem().string(), static_cast<int>(slab)));
}

// Files with hidden names beside those that they are to have, which they get all at once. What has
// not got its name is removed in the end.
class StagedFiles {
public:
    StagedFiles() = default;
    ~StagedFiles() {
        for (const Staged& file : files_) {
            std::error_code ignored;
            fs::remove(file.temporary, ignored);
        }
    }
    StagedFiles(const StagedFiles&) = delete;
    StagedFiles& operator=(const StagedFiles&) = delete;
    StagedFiles(StagedFiles&&) = delete;
    StagedFiles& operator=(StagedFiles&&) = delete;

    // Where to write what is to be at a path; a link there stays, and gets new content.
    [[nodiscard]] fs::path add(const fs::path& path) {
        refuse_folder(path);
        const fs::path target = fs::weakly_canonical(fs::absolute(path));
        const std::string name = target.filename().string();
        fs::path temporary = target;
        temporary.replace_filename(formatted(".%s.%d.staged", name.c_str(), ::getpid()));
        files_.push_back({temporary, target});
        return temporary;
    }

    void commit() {
        for (const Staged& file : files_) {
            std::error_code error;
            fs::rename(file.temporary, file.target, error);
            if (error) {
                // GCOVR_EXCL_START: rights that change meanwhile
                throw Error(file.target.string() + ": cannot be written: " + error.message());
                // GCOVR_EXCL_STOP
            }
        }
    }

private:
    struct Staged {
        fs::path temporary;
        fs::path target;
    };
    std::vector<Staged> files_;
};

// All slabs or none: where one cannot be written those of before stay as they are.
void write_slabs(const SpaceTimeBody& body, const fs::path& output, const WriteOptions& options) {
    StagedFiles files;
    for (std::size_t slab = 0; slab + 1 < body.frame_layers.size(); ++slab) {
        const MeshFile<4> file = mesher::slab_of(body, slab);
        write_mesh(files.add(slab_path(output, slab)), file.mesh, options, file.extras);
    }
    files.commit();
}

void write(const Program& program, const MeshArguments& arguments, const SpaceTimeBody& body) {
    const WriteOptions options{.encoding = arguments.ascii ? Encoding::Ascii : Encoding::Binary,
                               .created_by = program.name_and_version()};
    make_folder_for(arguments.output);
    if (arguments.space_time.has_slabs) {
        write_slabs(body, arguments.output, options);
    } else {
        write_mesh(arguments.output, body.mesh, options, body.extras);
    }
    if (!arguments.histogram.empty()) {
        make_folder_for(arguments.histogram);
        write_text(arguments.histogram,
                   mesher::quality_svg(body.quality, arguments.output.filename().string()));
    }
}

// From what is read, and from what else is written.
void require_slabs_apart(Program& program,
                         const MeshArguments& arguments,
                         const SpaceTimeBody& body) {
    if (!arguments.space_time.has_slabs) {
        return;
    }
    std::vector<NamedFile> inputs;
    for (const fs::path& path : mesher::frame_files(arguments.input, arguments.space_time.series)) {
        inputs.push_back({"a file that the input names", path});
    }
    std::vector<NamedFile> slabs;
    for (std::size_t slab = 0; slab + 1 < body.frame_layers.size(); ++slab) {
        slabs.push_back({"a slab", slab_path(arguments.output, slab)});
    }
    program.require_apart(inputs, slabs);
    program.require_apart(slabs, {{"--histogram", arguments.histogram}});
}

void say_time(const Program& program, const MeshArguments& arguments, const Made& made) {
    const double scale = arguments.space_time.options.time_scale;
    const SpaceTimeBody& body = made.body;
    const auto layers = static_cast<int>(body.frame_layers.back());
    program.say(formatted("moving     %lld frames from t = %.6g to %.6g s, mean edge %.4g m",
                          static_cast<Long>(made.frames), made.from, made.to, body.base_edge));
    const std::string heights =
        body.highest_layer > body.lowest_layer * (1 + 1e-9)
            ? formatted("%.4g to %.4g m", body.lowest_layer, body.highest_layer)
            : formatted("%.4g m", body.lowest_layer);
    // Where layers are 0.7 edges high, the worst cells of a body at rest are best.
    const double best = scale * 0.7 * body.base_edge * layers / (scale * (made.to - made.from));
    const Eigen::VectorXd& translation = arguments.request.translation;
    const double start = translation.size() == 4 ? translation[3] : 0;
    const std::string offset =
        start == 0 ? "" : formatted(" %c %g m", start < 0 ? '-' : '+', std::abs(start));
    program.say(formatted("time       w = %g m/s * t%s; ", scale, offset.c_str())
                + counted(layers, "layer", "layers") + " of " + heights
                + formatted(", best for cells at --time-scale %.3g", best));
}

void say_body(const Program& program, const Made& made) {
    const SpaceTimeBody& body = made.body;
    if (!made.cut.empty()) {
        program.say("cut        " + made.cut);
    }
    if (made.curved_cells > 0) {
        program.say(straight_line(made.curved_cells));
    }
    if (!made.left_out.empty()) {
        program.say("left out   " + made.left_out);
    }
    if (const std::string names = carried_names(body.mesh, body.extras); !names.empty()) {
        program.say("carried    " + names);
    }
    if (!body.way_of_bisection.empty()) {
        program.say("bisection  ready " + body.way_of_bisection);
    }
    program.say("body       " + size_text(body.mesh.vertex_count(), body.proof.cells, 4)
                + formatted(", %.10g m^4", body.proof.volume));
    program.say(
        formatted("integral   of the moving volume over w: %.10g m^4; the body has %.2g%% %s",
                  body.integral, 100 * std::abs(body.proof.volume / body.integral - 1),
                  body.proof.volume < body.integral ? "less" : "more"));
    program.say(box_line<4>(body.mesh.positions));
    program.say(proof_line(body.proof.interior_facets, body.proof.boundary_facets));
    program.say("quality    " + quality_line(body.quality));
}

nlohmann::ordered_json json_of(const MeshArguments& arguments, const Made& made) {
    const SpaceTimeBody& body = made.body;
    nlohmann::ordered_json json;
    json["space_time"] = {{"frames", made.frames},
                          {"from", made.from},
                          {"to", made.to},
                          {"time_scale", arguments.space_time.options.time_scale},
                          {"layers", body.frame_layers.back()},
                          {"frame_layers", body.frame_layers},
                          {"thinnest_layer", body.lowest_layer},
                          {"thickest_layer", body.highest_layer},
                          {"integral", body.integral},
                          {"cut", made.cut},
                          {"left_out", made.left_out},
                          {"curved", made.curved_cells},
                          {"carried", carried_names(body.mesh, body.extras)},
                          {"bisection", body.way_of_bisection}};
    json["mesh"] = {{"vertices", body.mesh.vertex_count()},
                    {"cells", body.proof.cells},
                    {"interior_facets", body.proof.interior_facets},
                    {"boundary_facets", body.proof.boundary_facets},
                    {"volume", body.proof.volume},
                    {"boundary_volume", body.proof.boundary_volume},
                    {"volume_tolerance", body.proof.tolerance},
                    {"box", box_json<4>(body.mesh.positions)}};
    json["quality"] = to_json(body.quality);
    return json;
}

}  // namespace

void make_and_write_space_time(Program& program, const MeshArguments& arguments) {
    Made made;
    {
        Heartbeat heartbeat(program.common().quiet);
        made = make(program, arguments, heartbeat);
        heartbeat.begin("write");
        require_slabs_apart(program, arguments, made.body);
        write(program, arguments, made.body);
    }
    say_time(program, arguments, made);
    say_body(program, made);
    if (arguments.show_quality) {
        program.say(mesher::quality_text(made.body.quality));
    }
    program.report().update(json_of(arguments, made));
    std::string output = arguments.output.string();
    if (arguments.space_time.has_slabs) {
        const std::size_t slabs = made.body.frame_layers.size() - 1;
        output = slab_path(arguments.output, 0).string() + " to "
                 + slab_path(arguments.output, slabs - 1).string();
    }
    program.report()["output"] = output;
    program.say("finished: " + output);
}

}  // namespace pent::apps
