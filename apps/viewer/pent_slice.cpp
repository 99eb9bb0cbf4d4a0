#include "common/program.h"
#include "common/values.h"
#include "view_options.h"

#include <pent/viewer/run_folder.h>
#include <pent/viewer/slice_run.h>

#include <functional>
#include <string>

namespace pent::apps {

namespace {

struct Arguments {
    ViewArguments view;
    std::string output;
    std::string format = "ply";
    bool keep_degenerate = false;
    bool has_boundary = false;
    bool has_obstacles = false;
};

void add_options(CLI::App& cli, Arguments& arguments) {
    add_view_options(cli, arguments.view);
    cli.add_option("-o,--output", arguments.output, "Folder for the slices; made if need be")
        ->required()
        ->type_name("OUT");
    cli.add_option("--format", arguments.format, "ply, obj or vtu; default: ply")
        ->transform(one_of({"ply", "obj", "vtu"}))
        ->type_name("KIND");
    cli.add_flag("--keep-degenerate", arguments.keep_degenerate,
                 "Keep the triangles of zero area that a slice through vertices has");
    cli.add_flag("--obstacles", arguments.has_obstacles,
                 "Add the obstacles of the scene, planes cut off around the bodies");
    cli.add_flag("--boundary", arguments.has_boundary,
                 "Add the whole boundary as tetrahedra with w, speed, strain and all quantities of "
                 "frames and meshes, VTU, for ParaView to slice");
}

viewer::SurfaceFormat to_format(const std::string& name) {
    if (name == "obj") {
        return viewer::SurfaceFormat::Obj;
    }
    return name == "vtu" ? viewer::SurfaceFormat::Vtu : viewer::SurfaceFormat::Ply;
}

// Whether what the scene has besides its bodies has been written.
std::string obstacle_note(int obstacles, const Arguments& arguments) {
    if (obstacles == 0) {
        return "";
    }
    const std::string count =
        "; " + std::to_string(obstacles) + (obstacles == 1 ? " obstacle " : " obstacles ");
    return count
           + (arguments.has_obstacles ? "in files of their own" : "left out (see --obstacles)");
}

Verdict slice(Program& program, const Arguments& arguments) {
    program.require_apart(inputs_of(arguments.view.input),
                          {{"--output", arguments.output},
                           taken_name(program.common().json, arguments.output,
                                      R"(slices\.csv|.+\.pvd|.+_\d{6,}\.(ply|obj|vtu))")});
    const viewer::RunFolder run = viewer::open_run(arguments.view.input);
    viewer::SliceRunOptions options;
    options.sections = to_sections(arguments.view);
    options.frames = viewer::select_frames(run.frames, arguments.view.frames);
    options.format = to_format(arguments.format);
    options.color = viewer::coloring_of(arguments.view.color);
    options.keep_degenerate = arguments.keep_degenerate;
    options.projection = to_projection(arguments.view);
    options.has_boundary = arguments.has_boundary;
    options.has_obstacles = arguments.has_obstacles;
    options.created_by = program.name_and_version();

    WorkProgress progress(program.common().quiet);
    const viewer::SliceRunReport report =
        viewer::slice_run(run, arguments.output, options, std::ref(progress));
    progress.finish();

    std::int64_t triangles = 0;
    for (const viewer::SliceRecord& slice : report.slices) {
        triangles += slice.is_obstacle ? 0 : slice.triangles;
    }
    program.report()["frames"] = options.frames.size();
    program.report()["slices"] = report.slices.size();
    program.report()["triangles"] = triangles;
    program.report()["obstacles"] = arguments.has_obstacles ? report.obstacles : 0;
    program.report()["output"] = arguments.output;
    program.say(std::string(report.is_complete ? "finished" : "stopped") + ": "
                + std::to_string(report.slices.size())
                + (report.slices.size() == 1 ? " slice, " : " slices, ") + std::to_string(triangles)
                + " triangles in " + arguments.output
                + (triangles == 0 ? " (the hyperplane misses the bodies)" : "")
                + "; volumes in slices.csv" + obstacle_note(report.obstacles, arguments));
    return report.is_complete ? Verdict::Finished : Verdict::Stopped;
}

}  // namespace

}  // namespace pent::apps

int main(int argc, char** argv) {
    pent::apps::Program program(
        "pent-slice", "Slices four-dimensional bodies by hyperplanes into closed surfaces.",
        "pent-slice RUN/ -o OUT/ --w -0.1,0,0.1 --color strain");
    pent::apps::Arguments arguments;
    add_options(program.options(), arguments);
    return program.run(argc, argv, [&] { return slice(program, arguments); });
}
