// Iterations and processor time of the linear solver over stiffness, size, shape and material.
//
//   bench_solver [--steps N] [--threads N] [--max-cells N] [--mesh FILE.pent]... [CASE]...
//
// Without cases all are run: beam, aspect, nu, free, boxes. A mesh is held at the eighth of its
// length that is lowest along y, falls, and is stepped at four stiffnesses.

#include "beams.h"

#include <pent/formatted.h>
#include <pent/pent_file.h>
#include <pent/simulator/simulation.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <sys/resource.h>

namespace {

using namespace pent;             // NOLINT(google-build-using-namespace)
using namespace pent::simulator;  // NOLINT(google-build-using-namespace)

struct Options {
    int steps = 4;
    int threads = 1;
    double max_cells = 1e6;
    std::vector<std::string> meshes;
    std::vector<std::string> cases;

    [[nodiscard]] bool has(const std::string& name) const {
        return (cases.empty() && meshes.empty())
               || std::find(cases.begin(), cases.end(), name) != cases.end();
    }
};

Options parse(int argc, char** argv) {
    Options options;
    for (int i = 1; i < argc; ++i) {
        const std::string name = argv[i];
        if (name.rfind("--", 0) != 0) {
            options.cases.push_back(name);
        } else if (i + 1 == argc) {
            std::fprintf(stderr, "bench_solver: %s: expected a value\n", argv[i]);
            std::exit(2);
        } else if (name == "--mesh") {
            options.meshes.emplace_back(argv[++i]);
        } else {
            const double value = std::atof(argv[++i]);  // NOLINT(cert-err34-c): 0 is refused
            if (!(value >= 1)) {
                std::fprintf(stderr, "bench_solver: %s: expected a number from 1\n", name.c_str());
                std::exit(2);
            }
            (name == "--steps" ? options.steps : options.threads) =
                name == "--max-cells" ? options.threads : static_cast<int>(value);
            if (name == "--max-cells") {
                options.max_cells = value;
            }
        }
    }
    return options;
}

double processor_seconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_utime.tv_sec)
           + 1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

template <int Dim>
void run(const std::string& name,
         const Scene& scene,
         const SimplexMesh<Dim>& mesh,
         const Options& options) {
    Simulation<Dim> simulation(scene, {mesh}, {.threads = options.threads, .isa = ""});
    std::string iterations;
    std::vector<double> seconds;
    bool is_accepted = true;
    for (int i = 0; i < options.steps; ++i) {
        const double before = processor_seconds();
        const StepReport report = simulation.step();
        seconds.push_back(processor_seconds() - before);
        iterations += " " + std::to_string(report.iterations);
        is_accepted = is_accepted && report.is_accepted;
    }
    std::printf("%-36s %9lld cells, %4.0f ms a step at least, iterations%s%s\n", name.c_str(),
                static_cast<long long>(simulation.size().cells),
                1e3 * *std::min_element(seconds.begin(), seconds.end()), iterations.c_str(),
                is_accepted ? "" : ", REFUSED");
    std::fflush(stdout);
}

// Held where y is lowest, and pulled by gravity along x.
Scene held_scene(double young, double poisson, double lowest, double length, int dim) {
    Scene scene = bench::beam_scene(poisson);
    scene.dimension = dim;
    scene.gravity = Eigen::VectorXd::Unit(dim, 0) * 9.8;
    scene.bodies[0].place.translate = Eigen::VectorXd::Zero(dim);
    scene.bodies[0].material.lame = lame_from_young(dim, young, poisson);
    scene.solver.tolerance = 1e-4;
    Motion still;
    still.translate = Eigen::VectorXd::Zero(dim);
    const HalfSpaceSelection end{.normal = Eigen::VectorXd::Unit(dim, 1),
                                 .offset = lowest + length / 8};
    scene.constraints = {{.body = "beam", .select = {end}, .motion = {still}}};
    return scene;
}

template <int Dim>
void run_mesh(const std::string& path, const Options& options) {
    const SimplexMesh<Dim> mesh = read_mesh<Dim>(path).mesh;
    const double lowest = mesh.positions.row(1).minCoeff();
    const double length = mesh.positions.row(1).maxCoeff() - lowest;
    for (const double young : {1e4, 1e5, 1e6, 1e7, 1e8}) {
        run<Dim>(formatted("%s, E = %.0e", path.substr(path.rfind('/') + 1).c_str(), young),
                 held_scene(young, 0.28, lowest, length, Dim), mesh, options);
    }
}

void run_boxes(const Options& options) {
    for (const std::array<int, 4>& count : {std::array{8, 8, 7, 7},
                                            {11, 10, 10, 10},
                                            {15, 15, 15, 14},
                                            {21, 20, 20, 20},
                                            {26, 26, 25, 25}}) {
        if (24.0 * count[0] * count[1] * count[2] * count[3] <= options.max_cells) {
            run<4>("box", bench::beam_scene(), bench::box(count), options);
        }
    }
}

void run_all(const Options& options) {
    if (options.has("beam")) {
        run<4>("beam", bench::beam_scene(), bench::beam(), options);
        for (const double young : {1e5, 1e9}) {
            Scene scene = bench::beam_scene();
            scene.bodies[0].material.lame = lame_from_young(4, young, 0.28);
            run<4>(formatted("beam, E = %.0e", young), scene, bench::beam(), options);
        }
    }
    if (options.has("aspect")) {
        for (const double thickness : {0.05, 0.01, 0.4}) {
            run<4>(formatted("beam, layers of %g of an edge", 10 * thickness), bench::beam_scene(),
                   bench::beam(thickness), options);
        }
    }
    if (options.has("nu")) {
        for (const double poisson : {0.0, 0.32, 0.33}) {
            run<4>(formatted("beam, nu = %g", poisson), bench::beam_scene(poisson), bench::beam(),
                   options);
        }
    }
    if (options.has("free")) {
        Scene scene = bench::beam_scene();
        scene.constraints.clear();
        run<4>("beam, free", scene, bench::beam(), options);
        scene.bodies[0].spin = {{.plane = {0, 1}, .degrees_per_s = 90}};
        run<4>("beam, free, spinning", scene, bench::beam(), options);
    }
    if (options.has("boxes")) {
        run_boxes(options);
    }
    for (const std::string& path : options.meshes) {
        read_info(path).dimension == 3 ? run_mesh<3>(path, options) : run_mesh<4>(path, options);
    }
}

}  // namespace

int main(int argc, char** argv) {
    try {
        run_all(parse(argc, argv));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "bench_solver: %s\n", error.what());
        return 1;
    }
    return 0;
}
