#include "readers.h"

#include "record/checkpoint_file.h"
#include "record/journal.h"
#include "record/run_report.h"
#include "support/temp_folder.h"
#ifdef PENT_FUZZ_STUDY
#include "record.h"
#include "trajectory.h"
#endif

#include <pent/crc32c.h>
#include <pent/error.h>
#include <pent/exchange/exchange.h>
#include <pent/formatted.h>
#include <pent/obstacles_file.h>
#include <pent/output_folder.h>
#include <pent/pent_file.h>
#include <pent/runs/scene_file.h>
#ifdef PENT_FUZZ_MESHER
#include <pent/mesher/boundary_solid.h>
#include <pent/mesher/edge_order.h>
#include <pent/mesher/image.h>
#include <pent/mesher/moving_mesh.h>
#include <pent/mesher/profile.h>
#include <pent/mesher/read_solid.h>
#include <pent/mesher/read_tetrahedra.h>
#include <pent/mesher/surface.h>
#endif

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace pent::fuzz {

namespace fs = std::filesystem;

namespace {

// A broken law: the fuzzer keeps the input that led here.
void require(bool holds, const char* law) {
    if (!holds) {
        std::fprintf(stderr, "broken law: %s\n", law);
        std::abort();
    }
}

// A folder of this process in memory, for readers that look at the ending of a name.
const fs::path& folder() {
    static const test::TempFolder folder("/dev/shm");
    return folder.path();
}

std::string content(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

template <int Dim>
void try_mesh(const fs::path& path) {
    const SimplexMesh<Dim> mesh = read_mesh<Dim>(path).mesh;
    validate(mesh, "accepted mesh");
    const fs::path copy = folder() / "copy.pent";
    write_mesh(copy, mesh);
    const SimplexMesh<Dim> again = read_mesh<Dim>(copy).mesh;
    require(again.positions == mesh.positions && again.cells == mesh.cells,
            "a mesh that is accepted survives being written and read");
}

template <int Dim>
void try_frame(const fs::path& path) {
    const Frame<Dim> frame = read_frame<Dim>(path);
    require(frame.positions.allFinite() && frame.velocities.allFinite(), "frames are finite");
    const fs::path copy = folder() / "copy.pent";
    write_frame(copy, frame);
    require(read_frame<Dim>(copy).positions == frame.positions,
            "a frame that is accepted survives being written and read");
}

void try_pent(const fs::path& path) {
    const FileInfo info = read_info(path);
    switch (info.dimension) {
        case 2:
            return info.is_frame ? try_frame<2>(path) : try_mesh<2>(path);
        case 3:
            return info.is_frame ? try_frame<3>(path) : try_mesh<3>(path);
        case 4:
            return info.is_frame ? try_frame<4>(path) : try_mesh<4>(path);
        default:
            require(false, "the dimension is 2, 3 or 4");
    }
}

// The same with the checksum put right, so that damage gets past it.
void try_pent_with_checksum(const fs::path& path) {
    std::string text = content(path);
    constexpr std::string_view kEnd = "end_header\n";
    constexpr std::string_view kSum = "comment crc32c ";
    constexpr std::string_view kHeaderSum = "comment header_crc32c ";
    if (const std::size_t line = text.find(kHeaderSum); line != std::string::npos) {
        text.erase(line, text.find('\n', line) - line + 1);  // as in files that have none
    }
    const std::size_t end = text.find(kEnd);
    const std::size_t sum = text.find(kSum);
    if (end != std::string::npos && sum != std::string::npos
        && sum + kSum.size() + 8 <= text.size()) {
        const std::size_t body = end + kEnd.size();
        text.replace(sum + kSum.size(), 8,
                     formatted("%08x", crc32c(text.data() + body, text.size() - body)));
        std::ofstream(path, std::ios::binary) << text;
    }
    try_pent(path);
}

void try_scene(const fs::path& path) {
    const auto read_again = [](const simulator::Scene& scene) {
        return runs::parse_scene(runs::scene_text(scene), "again", "");
    };
    const simulator::Scene scene = read_again(runs::read_scene(path));
    require(runs::scene_text(scene) == runs::scene_text(read_again(scene)),
            "a scene that is accepted survives being written and read");
}

template <int Dim>
void try_obstacles_of(const fs::path& path) {
    const fs::path copy = folder() / "copy.json";
    const fs::path again = folder() / "again.json";
    write_obstacles(copy, read_obstacles<Dim>(path));
    write_obstacles(again, read_obstacles<Dim>(copy));
    require(content(copy) == content(again),
            "obstacles that are accepted survive being written and read");
}

void try_obstacles(const fs::path& path) {
    try {
        try_obstacles_of<4>(path);
    } catch (const Error&) {
        try_obstacles_of<3>(path);
    }
}

// What a run left beside its last frame to be resumed from.
void try_checkpoint(const fs::path& path) {
    const runs::StateBlocks blocks = runs::read_checkpoint(path, 1, 2);
    const fs::path copy = folder() / "copy.state";
    runs::write_checkpoint(copy, 1, 2, blocks);
    require(runs::read_checkpoint(copy, 1, 2) == blocks,
            "a checkpoint that is accepted survives being written and read");
}

// The same with the checksum put right.
void try_checkpoint_with_checksum(const fs::path& path) {
    std::string text = content(path);
    if (text.size() >= 4) {
        const std::uint32_t sum = crc32c(text.data(), text.size() - 4);
        std::memcpy(text.data() + text.size() - 4, &sum, 4);
        std::ofstream(path, std::ios::binary) << text;
    }
    try_checkpoint(path);
}

void try_journal(const fs::path& path) {
    std::optional<runs::Journal> journal = runs::read_journal(path);
    require(journal.has_value(), "a file that is there is a journal");
    journal->cut(1);
    const fs::path copy = folder() / "copy.txt";
    std::ofstream(copy, std::ios::binary) << runs::journal_text(*journal);
    static_cast<void>(runs::read_journal(copy));
}

// The same with the checksum of each line put right.
void try_journal_with_checksum(const fs::path& path) {
    std::istringstream lines(content(path));
    std::string text;
    for (std::string line; std::getline(lines, line);) {
        const std::string entry = line.size() > 9 ? line.substr(9) : "";
        text += formatted("%08x ", crc32c(entry.data(), entry.size())) + entry + "\n";
    }
    std::ofstream(path, std::ios::binary) << text;
    try_journal(path);
}

// The list of what a program wrote into a folder.
void try_list(const fs::path& path) {
    const fs::path list = folder() / "listed";
    fs::create_directories(list);
    fs::copy_file(path, list / "written.txt", fs::copy_options::overwrite_existing);
    OutputFolder output(list, "run");
    output.remove_temporaries();
    if (output.has_list()) {
        output.clear({});
    }
}

// A report.json as a run of version 0.1.0 that is resumed and a study read it.
void try_report(const fs::path& path) {
    fs::copy_file(path, folder() / "report.json", fs::copy_options::overwrite_existing);
#ifdef PENT_FUZZ_STUDY
    static_cast<void>(study::verdict_of(folder()));
    static_cast<void>(study::Trajectory(simulator::Scene(), folder()));  // no bodies: no meshes
#endif
    static_cast<void>(runs::report_text(runs::read_report(path)));
}

#ifdef PENT_FUZZ_STUDY
void try_record(const fs::path& path) {
    const std::optional<study::Record> record = study::read_record(path);
    require(record.has_value(), "a file that is there is a record");
    static_cast<void>(study::cost_of(*record, 1));
    study::write_record(folder() / "copy.json", *record);
}
#endif

#ifdef PENT_FUZZ_MESHER
void try_surface(const fs::path& path) {
    const mesher::Surface surface = mesher::read_surface(path).surface;
    require(surface.points.allFinite() && surface.triangle_count() > 0
                && surface.triangles.maxCoeff() < surface.point_count(),
            "a surface has triangles of its finite points");
}

void try_tetrahedra(const fs::path& path) {
    validate(mesher::read_tetrahedra(path).mesh, "accepted mesh");
}

// TetGen's two files in one, the second behind a line "-- ele".
void try_tetgen(const fs::path& path) {
    const std::string text = content(path);
    constexpr std::string_view kCut = "-- ele\n";
    const std::size_t cut = text.find(kCut);
    const fs::path nodes = folder() / "pair.node";
    const fs::path elements = folder() / "pair.ele";
    std::ofstream(nodes, std::ios::binary) << text.substr(0, cut);
    std::ofstream(elements, std::ios::binary)
        << (cut == std::string::npos ? std::string() : text.substr(cut + kCut.size()));
    try_tetrahedra(nodes);
}

void try_edges(const fs::path& path) {
    constexpr std::int64_t kVertices = 100;
    const mesher::DirectedEdges edges = mesher::read_directed_edges(path, kVertices);
    require(edges.size() == 0 || edges.maxCoeff() < kVertices, "edges join vertices of the mesh");
}

void try_shape(const fs::path& path) {
    const mesher::Solid solid = mesher::read_solid(path);
    (void)solid.value({0.1, 0.2, 0.3, 0.4});
    require(solid.piece_count() > 0, "a shape that is accepted has a surface");
}

void check_moving(const mesher::MovingMesh& moving) {
    validate(moving.base, "accepted mesh");
    require(moving.positions.size() == moving.times.size() && moving.times.size() >= 2,
            "a moving mesh has two frames or more, with their times");
    for (const Positions<3>& positions : moving.positions) {
        require(positions.cols() == moving.base.vertex_count() && positions.allFinite(),
                "every frame has all vertices");
    }
    for (const mesher::MovingField& field : moving.vertex_fields) {
        require(field.values.size() == moving.times.size(), "fields are there in every frame");
    }
}

// One file as both frames of a series, with its arrays.
void try_frames(const fs::path& path) {
    const fs::path list = folder() / "list.pvd";
    const std::string name = path.filename().string();
    std::ofstream(list, std::ios::binary)
        << "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"0\" file=\"" << name
        << "\"/><DataSet timestep=\"1\" file=\"" << name << "\"/></Collection></VTKFile>";
    check_moving(mesher::read_moving_mesh(list));
}

// A list of frames; a.vtk and b.vtk are there.
void try_series(const fs::path& path) {
    for (const char* name : {"a.vtk", "b.vtk"}) {
        std::ofstream(folder() / name, std::ios::binary)
            << "# vtk DataFile Version 3.0\n-\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n"
               "0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n";
    }
    check_moving(mesher::read_moving_mesh(path));
}

void try_boundary(const fs::path& path) {
    const mesher::BoundarySolid body =
        mesher::boundary_solid(mesher::read_boundary(path), path.string());
    require(body.report.patches > 0 && std::isfinite(body.solid.value({0.1, 0.2, 0.3, 0.4})),
            "a boundary that is accepted encloses something");
}

void try_image(const fs::path& path) {
    const mesher::Image image = mesher::read_image(path);
    require(image.size.minCoeff() >= 2 && image.spacing.minCoeff() > 0
                && image.values.size() == image.index(image.size.array() - 1) + 1,
            "an image has a sample at every place");
}

void try_profile(const fs::path& path) {
    require(mesher::read_profile(path).size() >= 2, "a profile has two layers or more");
}
#endif

void try_exchange(const fs::path& path) {
    const exchange::Content found = exchange::read(path);
    if (const auto* body = std::get_if<exchange::Body>(&found)) {
        validate(body->mesh, "accepted mesh");
        return;
    }
    const auto& surface = std::get<exchange::TetSurface>(found);
    require(surface.points.allFinite() && surface.tetrahedra.cols() > 0
                && surface.tetrahedra.maxCoeff() < surface.points.cols(),
            "a boundary has tetrahedra of its finite points");
}

}  // namespace

const std::vector<Reader>& readers() {
    static const std::vector<Reader> all = {
        {"pent", ".pent", try_pent},
        {"pent_checksum", ".pent", try_pent_with_checksum},
        {"scene", ".toml", try_scene},
        {"obstacles", ".json", try_obstacles},
        {"report", ".json", try_report},
        {"checkpoint", ".state", try_checkpoint},
        {"checkpoint_checksum", ".state", try_checkpoint_with_checksum},
        {"journal", ".txt", try_journal},
        {"journal_checksum", ".txt", try_journal_with_checksum},
        {"list", ".txt", try_list},
        {"4do", ".4do", try_exchange},
        {"4obj", ".obj", try_exchange},
        {"4off", ".4off", try_exchange},
        {"g4mf", ".g4tf", try_exchange},
        {"g4mf_chunks", ".g4b", try_exchange},
        {"mfem", ".mfem", try_exchange},
#ifdef PENT_FUZZ_STUDY
        {"record", ".json", try_record},
#endif
#ifdef PENT_FUZZ_MESHER
        {"obj", ".obj", try_surface},
        {"off", ".off", try_surface},
        {"ply", ".ply", try_surface},
        {"stl", ".stl", try_surface},
        {"gltf", ".gltf", try_surface},
        {"gmsh", ".msh", try_tetrahedra},
        {"medit", ".mesh", try_tetrahedra},
        {"vtk", ".vtk", try_tetrahedra},
        {"vtk_arrays", ".vtk", try_frames},
        {"vtu", ".vtu", try_frames},
        {"pvd", ".pvd", try_series},
        {"series", ".series", try_series},
        {"tobj", ".tobj", try_tetrahedra},
        {"tetgen", ".pair", try_tetgen},
        {"edges", ".edges", try_edges},
        {"profile", ".profile", try_profile},
        {"shape", ".toml", try_shape},
        {"boundary", ".4off", try_boundary},
        {"nifti", ".nii", try_image},
        {"nrrd", ".nrrd", try_image},
#endif
    };
    return all;
}

const Reader* find_reader(const char* name) {
    for (const Reader& reader : readers()) {
        if (std::strcmp(reader.name, name) == 0) {
            return &reader;
        }
    }
    return nullptr;
}

bool try_bytes(const Reader& reader, const void* data, std::size_t bytes) {
    const fs::path path = folder() / (std::string("input") + reader.ending);
    std::ofstream(path, std::ios::binary)
        .write(static_cast<const char*>(data), static_cast<std::streamsize>(bytes));
    try {
        reader.try_file(path);
        return true;
    } catch (const Error& error) {
        require(*error.what() != '\0' && std::strchr(error.what(), '\n') == nullptr,
                "an error is one line");
        return false;
    }
}

}  // namespace pent::fuzz
