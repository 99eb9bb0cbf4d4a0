#include "meshes.h"

#include "random.h"
#include "support/cut_in_two.h"
#include "support/kuhn_box.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/pent_file.h>

#include <algorithm>
#include <regex>
#include <vector>

namespace pent::scene_fuzz {

namespace {

// The cells for which `is_kept` holds, and no vertex that none of them has.
template <int Dim, typename IsKept>
SimplexMesh<Dim> part_of(const SimplexMesh<Dim>& mesh, const IsKept& is_kept) {
    constexpr std::uint32_t kNone = 0xffffffff;
    std::vector<std::uint32_t> number(static_cast<std::size_t>(mesh.vertex_count()), kNone);
    SimplexMesh<Dim> part;
    part.positions.resize(Dim, mesh.vertex_count());
    part.cells.resize(Dim + 1, mesh.cell_count());
    Eigen::Index cells = 0;
    std::uint32_t vertices = 0;
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        Eigen::Matrix<double, Dim, 1> center = Eigen::Matrix<double, Dim, 1>::Zero();
        for (int corner = 0; corner <= Dim; ++corner) {
            center += mesh.positions.col(mesh.cells(corner, cell)) / (Dim + 1);
        }
        if (!is_kept(center)) {
            continue;
        }
        for (int corner = 0; corner <= Dim; ++corner) {
            std::uint32_t& to = number[mesh.cells(corner, cell)];
            if (to == kNone) {
                to = vertices++;
                part.positions.col(to) = mesh.positions.col(mesh.cells(corner, cell));
            }
            part.cells(corner, cells) = to;
        }
        ++cells;
    }
    part.positions.conservativeResize(Dim, vertices);
    part.cells.conservativeResize(Dim + 1, cells);
    return part;
}

// Vertices of a box of cubes are numbered with the first axis fastest: those of a layer in a row.
template <int Dim>
void add_layers(SimplexMesh<Dim>& mesh, int layers) {
    const Eigen::Index columns = mesh.vertex_count() / (layers + 1);
    for (Eigen::Index vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
        mesh.columns.push_back(static_cast<std::uint32_t>(vertex % columns));
        mesh.layers.push_back(static_cast<std::uint32_t>(vertex / columns));
    }
}

template <int Dim>
void add_regions(SimplexMesh<Dim>& mesh, double slab) {
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        double center = 0;
        for (int corner = 0; corner <= Dim; ++corner) {
            center += mesh.positions(0, mesh.cells(corner, cell)) / (Dim + 1);
        }
        mesh.regions.push_back(static_cast<std::uint16_t>(center / slab));
    }
}

template <int Dim>
SimplexMesh<Dim> corner_simplex(const std::array<double, Dim>& size) {
    SimplexMesh<Dim> mesh;
    mesh.positions.setZero(Dim, Dim + 1);
    mesh.cells.resize(Dim + 1, 1);
    for (int i = 0; i <= Dim; ++i) {
        mesh.cells(i, 0) = static_cast<std::uint32_t>(i);
        if (i > 0) {
            mesh.positions(i - 1, i) = size[static_cast<std::size_t>(i - 1)];
        }
    }
    return mesh;
}

}  // namespace

std::string text_of(const MeshName& name) {
    std::string counts;
    std::string sizes;
    for (int axis = 0; axis < name.dimension; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        counts += (axis > 0 ? "x" : "") + std::to_string(name.count[i]);
        sizes += (axis > 0 ? "x" : "") + formatted("%.3g", name.size[i]);
    }
    return (name.is_quadratic ? "quadratic-" : "") + name.kind + "-" + counts + "-" + sizes
           + ".pent";
}

MeshName parse_mesh_name(const std::string& text) {
    static const std::regex kForm(
        "(?:.*/)?(quadratic-)?(box|layered|regions|fork|simplex|pieces)-([0-9x]+)-([0-9x.e+-]+)"
        "\\.pent");
    std::smatch match;
    if (!std::regex_match(text, match, kForm)) {
        throw Error(text + ": is not the name of a mesh of scene_fuzz, such as"
                           " \"box-2x1x1-0.6x0.3x0.3.pent\"");
    }
    MeshName name;
    name.is_quadratic = match[1].matched;
    name.kind = match[2];
    const auto read = [](const std::string& list, auto& values, const auto& convert) {
        static const std::regex kCross("x");
        std::size_t count = 0;
        for (std::sregex_token_iterator at(list.begin(), list.end(), kCross, -1), end; at != end;
             ++at) {
            if (count == values.size()) {
                throw Error(list + ": has more than four numbers");
            }
            values[count++] = convert(at->str());
        }
        return count;
    };
    const std::size_t counts =
        read(match[3], name.count, [](const std::string& s) { return std::stoi(s); });
    const std::size_t sizes =
        read(match[4], name.size, [](const std::string& s) { return std::stod(s); });
    if (counts != sizes || counts < 3) {
        throw Error(text + ": needs three or four counts, and as many sizes");
    }
    name.dimension = static_cast<int>(counts);
    return name;
}

template <int Dim>
SimplexMesh<Dim> make_mesh(const MeshName& name) {
    std::array<int, Dim> count{};
    std::array<double, Dim> size{};
    std::copy_n(name.count.begin(), Dim, count.begin());
    std::copy_n(name.size.begin(), Dim, size.begin());
    const double width = size[0] / count[0];
    const Eigen::Map<const Eigen::Matrix<double, Dim, 1>> box(size.data());
    SimplexMesh<Dim> mesh =
        name.kind == "simplex" ? corner_simplex<Dim>(size) : test::kuhn_box<Dim>(count, size);
    if (name.kind == "layered") {
        add_layers<Dim>(mesh, count[Dim - 1]);
    } else if (name.kind == "regions") {
        add_regions<Dim>(mesh, width);
    } else if (name.kind == "fork") {
        mesh = part_of<Dim>(mesh, [&](const auto& center) {
            return center[0] < width || center[0] > size[0] - width || center[1] < size[1] / 2;
        });
    } else if (name.kind == "pieces") {
        mesh = part_of<Dim>(mesh, [&](const auto& center) {
            return center[0] < width || center[0] > size[0] - width;
        });
    }
    mesh.positions.colwise() -= 0.5 * box;
    return name.is_quadratic ? test::cut_in_two<Dim>(mesh) : mesh;
}

template SimplexMesh<3> make_mesh<3>(const MeshName&);
template SimplexMesh<4> make_mesh<4>(const MeshName&);

void write_meshes(const Json& scene, const std::filesystem::path& folder) {
    if (!scene.contains("body")) {
        return;
    }
    for (const Json& body : scene["body"]) {
        const std::string file = body.value("mesh", "");
        if (file.empty() || std::filesystem::exists(folder / file)) {
            continue;
        }
        const MeshName name = parse_mesh_name(file);
        if (name.dimension == 3) {
            static_cast<void>(write_mesh<3>(folder / file, make_mesh<3>(name)));
        } else {
            static_cast<void>(write_mesh<4>(folder / file, make_mesh<4>(name)));
        }
    }
}

}  // namespace pent::scene_fuzz
