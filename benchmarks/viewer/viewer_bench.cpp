// The work of the viewer on 250k pentachora, and a picture of 100k triangles.
// Targets on 2 cores: 20 slices a second, written; 2 pictures of 1280 x 720 a second.

#include "support/kuhn_box.h"

#include <pent/viewer/attributes.h>
#include <pent/viewer/boundary.h>
#include <pent/viewer/render.h>
#include <pent/viewer/slice.h>
#include <pent/viewer/surface_file.h>

#include <benchmark/benchmark.h>

#include <cmath>
#include <filesystem>

namespace pent::viewer {
namespace {

// 250k pentachora: a bar of 48 x 6 x 6 x 6 tesseracts, bent so that slices differ from its layers.
SimplexMesh<4> make_bar() {
    SimplexMesh<4> mesh = test::kuhn_box<4>({48, 6, 6, 6}, {4.8, 0.6, 0.6, 0.6});
    for (auto point : mesh.positions.colwise()) {
        const double angle = 0.3 * point.x();
        const double y = point.y();
        point.y() = y * std::cos(angle) - point.w() * std::sin(angle);
        point.w() = y * std::sin(angle) + point.w() * std::cos(angle);
    }
    return mesh;
}

// 100k triangles that fill most of the picture and shade one another: a slab with wavy sides.
RenderObject make_waves() {
    SimplexMesh<3> mesh = test::kuhn_box<3>({158, 158, 1}, {2, 2, 2});
    mesh.positions.array() -= 1;
    for (auto point : mesh.positions.colwise()) {
        point.z() *= 0.6 + 0.3 * std::cos(7 * point.x()) * std::cos(5 * point.y());
    }
    const Boundary<3> boundary = make_boundary(mesh, "waves");
    const Surface surface = skin(boundary, mesh.positions);
    RenderObject object;
    object.positions = surface.positions;
    object.triangles = surface.triangles;
    object.normals =
        corner_normals<3>(surface, boundary, mesh.positions, Eigen::Matrix3d::Identity(), 1.0);
    object.colors.setConstant(3, surface.vertex_count(), 0.5F);
    return object;
}

void make_boundary_of_250k(benchmark::State& state) {
    const SimplexMesh<4> mesh = make_bar();
    for (auto _ : state) {
        benchmark::DoNotOptimize(make_boundary(mesh, "bar"));
    }
    state.counters["pentachora"] = static_cast<double>(mesh.cell_count());
}
BENCHMARK(make_boundary_of_250k)->Unit(benchmark::kMillisecond)->UseRealTime();

void slice_250k(benchmark::State& state) {
    const SimplexMesh<4> mesh = make_bar();
    const Boundary<4> boundary = make_boundary(mesh, "bar");
    Eigen::Index triangles = 0;
    for (auto _ : state) {
        const Surface surface = slice(boundary, mesh.positions, hyperplane_at(0.3));
        triangles = surface.triangle_count();
    }
    state.counters["tetrahedra"] = static_cast<double>(boundary.facets.cols());
    state.counters["triangles"] = static_cast<double>(triangles);
}
BENCHMARK(slice_250k)->Unit(benchmark::kMillisecond)->UseRealTime();

void slice_and_write_250k(benchmark::State& state) {
    const SimplexMesh<4> mesh = make_bar();
    const Boundary<4> boundary = make_boundary(mesh, "bar");
    const std::filesystem::path path = std::filesystem::temp_directory_path() / "pent-bench.ply";
    for (auto _ : state) {
        const Surface surface =
            merge_coincident(slice(boundary, mesh.positions, hyperplane_at(0.3)));
        write_surface(path, surface, SurfaceFormat::Ply);
    }
    std::filesystem::remove(path);
}
BENCHMARK(slice_and_write_250k)->Unit(benchmark::kMillisecond)->UseRealTime();

void strain_250k(benchmark::State& state) {
    const SimplexMesh<4> mesh = make_bar();
    for (auto _ : state) {
        benchmark::DoNotOptimize(vertex_strain<4>(mesh, mesh.positions));
    }
}
BENCHMARK(strain_250k)->Unit(benchmark::kMillisecond)->UseRealTime();

void render_100k_triangles_720p(benchmark::State& state) {
    const RenderObject object = make_waves();
    const Renderer renderer;
    RenderOptions options;
    options.floor = -1;
    options.scene_size = 3;
    const Camera camera{.position = {2, 1.5, 4.5}};
    for (auto _ : state) {
        benchmark::DoNotOptimize(renderer.render({&object, 1}, camera, options));
    }
    state.counters["triangles"] = static_cast<double>(object.triangles.cols());
}
BENCHMARK(render_100k_triangles_720p)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace pent::viewer
