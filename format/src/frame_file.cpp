#include "body.h"
#include "input_file.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/pent_file.h>

#include <cmath>
#include <utility>

namespace pent {

namespace {

template <int Dim>
void check_finite(const Positions<Dim>& values,
                  std::string_view prefix,
                  const std::filesystem::path& path,
                  std::uint64_t first = 0) {
    constexpr std::string_view kAxes = "xyzw";
    for (Eigen::Index vertex = 0; vertex < values.cols(); ++vertex) {
        for (int axis = 0; axis < Dim; ++axis) {
            if (!std::isfinite(values(axis, vertex))) {
                throw Error(path.string() + ": vertex "
                            + std::to_string(first + static_cast<std::uint64_t>(vertex)) + ": "
                            + std::string(prefix) + kAxes[axis] + " is "
                            + std::to_string(values(axis, vertex)) + ", expected a finite number");
            }
        }
    }
}

// @param writers  Of which some may have no vertices; null for one alone.
template <int Dim>
std::vector<Column> frame_columns(const Frame<Dim>& frame, const SlabWriters* writers) {
    std::vector<Column> columns = vector_columns<Dim>(frame.positions, "");
    const auto append = [&](const Positions<Dim>& values, std::string_view prefix) {
        if (place_slab(writers, static_cast<std::uint64_t>(values.cols())).all > 0) {
            const std::vector<Column> more = vector_columns<Dim>(values, prefix);
            columns.insert(columns.end(), more.begin(), more.end());
        }
    };
    append(frame.velocities, "v");
    append(frame.contact_forces, "f");
    for (const VertexField& field : frame.fields) {
        const std::vector<Column> more = field_columns(field);
        columns.insert(columns.end(), more.begin(), more.end());
    }
    return columns;
}

template <int Dim>
void check_count(const Positions<Dim>& values,
                 Eigen::Index expected,
                 const char* what,
                 const std::filesystem::path& path) {
    if (values.cols() != 0 && values.cols() != expected) {
        throw Error(path.string() + ": " + std::to_string(values.cols()) + " " + what
                    + ", expected none or " + std::to_string(expected));
    }
}

// @param first  How many vertices lie in front of those of the frame.
template <int Dim>
void check(const Frame<Dim>& frame, const std::filesystem::path& path, std::uint64_t first) {
    check_finite<Dim>(frame.positions, "", path, first);
    check_finite<Dim>(frame.velocities, "v", path, first);
    check_finite<Dim>(frame.contact_forces, "f", path, first);
    check_count<Dim>(frame.velocities, frame.positions.cols(), "velocities", path);
    check_count<Dim>(frame.contact_forces, frame.positions.cols(), "contact forces", path);
    check_fields(frame.fields, Dim, frame.positions.cols(), "vertex", path, first);
    check_names(frame.fields, Dim, axis_names(Dim, kVertexVectors), "vertex", path);
    if (frame.mesh_name.empty() || frame.mesh_name.find_first_of(" \n\r") != std::string::npos) {
        throw Error(path.string() + ": mesh name '" + frame.mesh_name
                    + "', expected a name without spaces");
    }
}

}  // namespace

template <int Dim>
void write_frame(const std::filesystem::path& path,
                 const Frame<Dim>& frame,
                 const WriteOptions& options) {
    const std::vector<Column> columns = frame_columns(frame, options.writers);
    const auto count = static_cast<std::uint64_t>(frame.positions.cols());
    const SlabPlace slab = place_slab(options.writers, count);
    if (options.writers == nullptr) {
        check<Dim>(frame, path, 0);
    } else {
        options.writers->agree([&] { check<Dim>(frame, path, slab.before); });
    }
    Header header;
    header.info.dimension = Dim;
    header.info.encoding = options.encoding;
    header.info.created_by = options.created_by;
    header.info.is_frame = true;
    header.mesh_name = frame.mesh_name;
    header.mesh_crc = frame.mesh_crc;
    header.frame = frame.frame;
    header.step = frame.step;
    header.time = frame.time;
    header.elements = {make_element("vertex", slab.all, columns)};
    std::string body;
    encode_rows(body, options.encoding, columns, count);
    write_file(path, std::move(header), body, options.writers);
}

template <int Dim>
Frame<Dim> read_frame(const std::filesystem::path& path) {
    const InputFile file = read_input(path);
    const Header header = parse_header(file.view(), path);
    if (header.info.dimension != Dim) {
        throw Error(path.string() + ": header: dimension " + std::to_string(header.info.dimension)
                    + ", expected " + std::to_string(Dim));
    }
    if (!header.info.is_frame) {
        throw Error(path.string()
                    + ": header: no 'comment mesh NAME CRC', expected a frame (this is a mesh)");
    }
    BodyReader reader(header, file.view(), path);
    Frame<Dim> frame;
    const auto count = static_cast<Eigen::Index>(header.info.vertices);
    frame.positions.resize(Dim, count);
    if (has_vector(header.elements[0], Dim, "v", "velocity", path)) {
        frame.velocities.resize(Dim, count);
    }
    if (has_vector(header.elements[0], Dim, "f", "contact force", path)) {
        frame.contact_forces.resize(Dim, count);
    }
    frame.fields = fields_of(header.elements[0], Dim, kVertexVectors);
    frame.mesh_name = header.mesh_name;
    frame.mesh_crc = header.mesh_crc;
    frame.frame = header.frame;
    frame.step = header.step;
    frame.time = header.time;
    reader.read(frame_columns<Dim>(frame, nullptr));
    reader.finish();
    check_finite<Dim>(frame.positions, "", path);
    check_finite<Dim>(frame.velocities, "v", path);
    check_finite<Dim>(frame.contact_forces, "f", path);
    check_fields(frame.fields, Dim, frame.positions.cols(), "vertex", path);
    return frame;
}

std::string frame_file_name(const std::string& body, int frame) {
    return body + formatted("_%06d.pent", frame);
}

#define PENT_INSTANTIATE(Dim)                                                       \
    template void write_frame<Dim>(const std::filesystem::path&, const Frame<Dim>&, \
                                   const WriteOptions&);                            \
    template Frame<Dim> read_frame<Dim>(const std::filesystem::path&);
PENT_INSTANTIATE(2)
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
#undef PENT_INSTANTIATE

}  // namespace pent
