#include "formats.h"

#include <pent/error.h>
#include <pent/input_path.h>
#include <pent/pent_file.h>

#include <algorithm>
#include <array>
#include <string>

namespace pent::exchange {

namespace {

constexpr std::array<std::string_view, 1> kPent = {".pent"};
constexpr std::array<std::string_view, 2> k4off = {".off", ".4off"};
constexpr std::array<std::string_view, 2> kG4mf = {".g4tf", ".g4b"};
constexpr std::array<std::string_view, 1> k4do = {".4do"};
constexpr std::array<std::string_view, 1> k4obj = {".obj"};
constexpr std::array<std::string_view, 2> kMfem = {".mesh", ".mfem"};

constexpr std::array kFormats = {
    Format{".pent", kPent, true, read_pent, write_pent},
    Format{"4OFF", k4off, false, read_4off, write_4off},
    Format{"G4MF", kG4mf, false, read_g4mf, write_g4mf},
    Format{"4DO", k4do, false, read_4do, write_4do},
    Format{"OBJ of tesserxel", k4obj, false, read_4obj, write_4obj},
    Format{"MFEM mesh", kMfem, true, read_mfem, write_mfem},
};

}  // namespace

Content read_pent(const std::filesystem::path& path) {
    return read_mesh<4>(path).mesh;
}

void write_pent(const std::filesystem::path& path,
                const Content& content,
                const WriteOptions& options) {
    const auto& mesh = std::get<SimplexMesh<4>>(content);
    validate<4>(mesh, path.string());
    static_cast<void>(write_mesh<4>(path, mesh, {.created_by = options.created_by}));
}

std::span<const Format> formats() {
    return kFormats;
}

const Format& format_of(const std::filesystem::path& path) {
    const std::string ending = pent::format_of(path, "");
    std::string known;
    for (const Format& format : kFormats) {
        if (std::ranges::find(format.endings, ending) != format.endings.end()) {
            return format;
        }
        for (const std::string_view one : format.endings) {
            known += (known.empty() ? "" : ", ") + std::string(one);
        }
    }
    throw Error(path.string() + ": "
                + (ending.empty() ? "a name without an ending" : "a name that ends in " + ending)
                + "; expected one of " + known);
}

Content read(const std::filesystem::path& path) {
    const Format& format = format_of(path);
    require_file(path);
    Content content = format.read(path);
    if (auto* surface = std::get_if<TetSurface>(&content)) {
        if (surface->tetrahedra.cols() == 0) {
            throw Error(path.string() + ": no tetrahedron in it; expected the boundary of a body of"
                                        " four dimensions");
        }
        orient(*surface, path.string());
    }
    return content;
}

void write(const std::filesystem::path& path, const Content& content, const WriteOptions& options) {
    const Format& format = format_of(path);
    const auto* mesh = std::get_if<SimplexMesh<4>>(&content);
    if (mesh != nullptr && !format.has_cells) {
        format.write(path, boundary_of(*mesh), options);
    } else if (mesh == nullptr && format.has_cells) {
        format.write(path, cone_of(std::get<TetSurface>(content), path.string()), options);
    } else {
        format.write(path, content, options);
    }
}

}  // namespace pent::exchange
