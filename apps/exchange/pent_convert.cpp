#include "common/program.h"

#include <pent/counted.h>
#include <pent/error.h>
#include <pent/exchange/exchange.h>
#include <pent/formatted.h>
#include <pent/input_path.h>
#include <pent/pent_file.h>

#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace pent::apps {

namespace {

struct Arguments {
    std::string input;
    std::string output;
    std::vector<std::filesystem::path> frames;
    exchange::WriteOptions options;
};

void add_options(CLI::App& cli, Arguments& arguments) {
    cli.add_option("input", arguments.input,
                   "A body (.pent, .mesh) or a boundary (.off, .4off, .g4tf,"
                   " .g4b, .4do, .obj)")
        ->required()
        ->type_name("IN");
    cli.add_option("-o,--output", arguments.output,
                   "The same in the format that its ending stands for; or a view of the boundary "
                   "(.vtk, .msh)")
        ->required()
        ->type_name("OUT");
    cli.add_option("--frames", arguments.frames,
                   "G4MF: frames of the .pent mesh, as of run/frames; each becomes a blend shape")
        ->type_name("FRAME");
    cli.add_flag("--double", arguments.options.in_double,
                 "G4MF: coordinates in double, which not every program reads");
    cli.add_flag(
        "--mfem-attributes", arguments.options.has_mfem_attributes,
        "MFEM: number the boundary after the labels of the cells, as MFEM's own meshes have"
        " it; default: those of the body, or 1 bottom, 2 lateral, 3 top");
}

// Frames of pent-sim, of the mesh that is converted.
std::vector<exchange::FramePoints> read_frames(const Arguments& arguments) {
    std::vector<exchange::FramePoints> frames;
    if (arguments.frames.empty()) {
        return frames;
    }
    if (format_of(arguments.input, "") != ".pent") {
        throw Error(arguments.input + ": frames are of a .pent mesh, and this is none");
    }
    const FileInfo info = read_info(arguments.input);
    for (const std::filesystem::path& path : arguments.frames) {
        Frame<4> frame = read_frame<4>(path);
        if (frame.mesh_crc != info.crc32c) {
            throw Error(path.string() + ": is a frame of another mesh than " + arguments.input);
        }
        frames.push_back({path.stem().string() + formatted(" at %.9g s", frame.time),
                          std::move(frame.positions)});
    }
    return frames;
}

void say_surface(Program& program, const exchange::TetSurface& surface) {
    const exchange::SurfaceCheck check = exchange::check(surface);
    const std::string size = counted(surface.points.cols(), "point", "points") + ", "
                             + counted(surface.tetrahedra.cols(), "tetrahedron", "tetrahedra");
    if (check.is_oriented()) {
        program.say("boundary   " + size + ", closed, around "
                    + formatted("%.6g m^4", exchange::enclosed_hypervolume(surface)));
        program.report()["hypervolume"] = exchange::enclosed_hypervolume(surface);
    } else {
        program.say("boundary   " + size
                    + ", not closed: " + counted(check.open, "open triangle", "open triangles")
                    + ", " + std::to_string(check.overfull) + " of more than two");
    }
    program.report()["points"] = surface.points.cols();
    program.report()["tetrahedra"] = surface.tetrahedra.cols();
    program.report()["open"] = check.open;
    program.report()["overfull"] = check.overfull;
}

void say_body(Program& program, const exchange::Body& body, const exchange::Format& format) {
    const SimplexMesh<4>& mesh = body.mesh;
    program.say("body       " + counted(mesh.vertex_count(), "vertex", "vertices") + ", "
                + counted(mesh.cell_count(), "pentachoron", "pentachora") + ", "
                + formatted("%.6g m^4", total_volume(mesh)));
    program.report()["vertices"] = mesh.vertex_count();
    program.report()["cells"] = mesh.cell_count();
    program.report()["hypervolume"] = total_volume(mesh);
    const std::string left_out = exchange::left_out(body, format);
    if (!left_out.empty()) {
        program.say("left out   " + left_out + ": " + std::string(format.name)
                    + " has no place for them");
    }
    program.report()["left_out"] = left_out;
}

Verdict convert(Program& program, Arguments& arguments) {
    std::vector<NamedFile> inputs = {{"the input", arguments.input}};
    for (const std::filesystem::path& frame : arguments.frames) {
        inputs.push_back({"--frames", frame});
    }
    program.require_apart(inputs, {{"--output", arguments.output}});
    const exchange::Format& format = exchange::format_of(arguments.output);  // before any work
    arguments.options.created_by = program.name_and_version();
    const exchange::Content content = exchange::read(arguments.input);
    if (const auto* surface = std::get_if<exchange::TetSurface>(&content)) {
        say_surface(program, *surface);
    } else {
        say_body(program, std::get<exchange::Body>(content), format);
    }
    arguments.options.frames = read_frames(arguments);
    make_folder_for(arguments.output);
    exchange::write(arguments.output, content, arguments.options);
    if (!arguments.options.frames.empty()) {
        program.say("frames     " + std::to_string(arguments.options.frames.size())
                    + ", a blend shape each");
        program.report()["frames"] = arguments.options.frames.size();
    }
    program.report()["output"] = arguments.output;
    program.say("finished: " + arguments.output);
    return Verdict::Finished;
}

}  // namespace

}  // namespace pent::apps

int main(int argc, char** argv) {
    pent::apps::Program program(
        "pent-convert",
        "Converts bodies of four dimensions and their boundaries to and from the files of other"
        " programs. Of a body, formats of boundaries get the boundary; a boundary becomes a body "
        "if a"
        " point sees all of it.",
        "pent-convert octopus.pent -o octopus.g4b");
    pent::apps::Arguments arguments;
    add_options(program.options(), arguments);
    return program.run(argc, argv, [&] { return convert(program, arguments); });
}
