// The scenes of data/scenes, the study scenes, muscles with fibers by distances and the barrier's
// stress scenes by pent-sim-mpi on several numbers of ranks beside pent-sim:
// scripts/ranks_equality.sh runs it and says what it prints.
//
//     ranks_equality PROGRAMS DATA WORK [SCENE...]
//
// Exits with 1 unless all scenes are the same.

#include "equality_scenes.h"
#include "support/crossing_checker.h"

#include <pent/error.h>
#include <pent/pent_file.h>
#include <pent/runs/report.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace pent::test {
namespace {

namespace fs = std::filesystem;
using simulator::StepReport;

constexpr std::array kRanks = {1, 2, 3, 4, 7};

// What a first step may differ by, over how far it goes, and its energies and momenta over what
// they are made of.
constexpr double kSame = 1e-6;

// How two runs differ, of which one is that of pent-sim.
struct Difference {
    double first = 0;               // of positions after a step, over the motion
    double last = 0;                // of positions after the last step, over the motion
    double energy = 0;              // of any energy after a step, over all of them
    double momentum = 0;            // of momentum and angular momentum after a step, over both
    bool has_same_contacts = true;  // in the first step in which they hold energy
    std::int64_t contacts = 0;      // of pent-sim there
    int crossings = 0;              // of surfaces at any step of either

    [[nodiscard]] bool is_same() const {
        return first < kSame && energy < kSame && momentum < kSame && has_same_contacts
               && crossings == 0;
    }
    void take(const Difference& other) {
        first = std::max(first, other.first);
        last = std::max(last, other.last);
        energy = std::max(energy, other.energy);
        momentum = std::max(momentum, other.momentum);
        has_same_contacts = has_same_contacts && other.has_same_contacts;
        contacts = std::max(contacts, other.contacts);
        crossings += other.crossings;
    }
};

std::string text_of(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

// Runs a scene, from its file or from the nudged one, by so many ranks, or by pent-sim where that
// is 0, and returns the folder.
fs::path simulate(const Places& places, const QuickScene& scene, const fs::path& file, int ranks) {
    const fs::path folder = places.work / (file.stem().string() + "_" + std::to_string(ranks));
    const std::string program = ranks == 0
                                    ? "timeout 600 " + (places.programs / "pent-sim").string()
                                    : "timeout 600 mpirun -q --oversubscribe --bind-to none -n "
                                          + std::to_string(ranks) + " "
                                          + (places.programs / "pent-sim-mpi").string();
    const std::string log = folder.string() + ".log";
    const std::string command = program + " " + file.string() + " -o " + folder.string()
                                + " --threads 1 --force </dev/null >" + log + " 2>&1";
    if (std::system(command.c_str()) != 0) {  // NOLINT(cert-env33-c)
        throw Error(scene.name + " failed on " + std::to_string(ranks) + " ranks: " + text_of(log));
    }
    return folder;
}

// All bodies in one, at a step.
template <int Dim>
Positions<Dim> positions_at(const QuickScene& scene, const fs::path& folder, int step) {
    Positions<Dim> all(Dim, 0);
    for (const simulator::Body& body : scene.scene.bodies) {
        const Positions<Dim> own =
            read_frame<Dim>(folder / "frames" / frame_file_name(body.name, step)).positions;
        all.conservativeResize(Dim, all.cols() + own.cols());
        all.rightCols(own.cols()) = own;
    }
    return all;
}

// Of bodies that a barrier keeps apart, by brute force.
template <int Dim>
int crossings_at(const QuickScene& scene, const Positions<Dim>& positions) {
    if (!scene.scene.contact || scene.scene.contact->model != contact::ContactModel::Barrier) {
        return 0;
    }
    std::vector<contact::Surface<Dim>> surfaces;
    std::uint32_t first = 0;
    for (const simulator::Body& body : scene.scene.bodies) {
        const SimplexMesh<Dim> mesh = read_mesh<Dim>(body.mesh).mesh;
        surfaces.push_back(contact::make_surface<Dim>(mesh.cells, mesh.vertex_count(), first));
        first += static_cast<std::uint32_t>(mesh.vertex_count());
    }
    int count = 0;
    for (std::size_t a = 0; a < surfaces.size(); ++a) {
        for (std::size_t b = scene.scene.contact->self ? a : a + 1; b < surfaces.size(); ++b) {
            count += count_crossings<Dim>(surfaces[a], surfaces[b], positions);
        }
    }
    return count;
}

std::int64_t contacts_of(const StepReport& step) {
    return step.contact.point_facet + step.contact.mixed + step.contact.obstacle;
}

double size_of_energies(const StepReport& step) {
    double sum = step.energies.kinetic;
    for (const simulator::TermEnergy& term : step.energies.terms) {
        sum += std::abs(term.energy);
    }
    return sum;
}

// Bodies placed at just the distance of contact touch or not as rounding has it, without energy.
bool do_contacts_count(const StepReport& step) {
    constexpr double kRounding = 1e-12;
    return step.energies.of("contact") + step.energies.of("obstacle")
           > kRounding * size_of_energies(step);
}

double energy_difference(const StepReport& own, const StepReport& other) {
    const double scale = size_of_energies(other);
    double most = std::abs(own.energies.kinetic - other.energies.kinetic);
    for (std::size_t i = 0; i < other.energies.terms.size(); ++i) {
        const double energy = other.energies.terms[i].energy;
        most = std::max(most, std::abs(own.energies.terms.at(i).energy - energy));
    }
    return scale > 0 ? most / scale : most;
}

double momentum_difference(const StepReport& own, const StepReport& other) {
    double scale = 0;
    double most = 0;
    const auto add = [&](const std::vector<double>& a, const std::vector<double>& b) {
        for (std::size_t i = 0; i < b.size(); ++i) {
            scale = std::max(scale, std::abs(b[i]));
            most = std::max(most, std::abs(a.at(i) - b[i]));
        }
    };
    add(own.momentum, other.momentum);
    add(own.angular_momentum, other.angular_momentum);
    return scale > 0 ? most / scale : most;
}

template <int Dim>
Difference difference(const QuickScene& scene, const fs::path& own, const fs::path& alone) {
    const runs::RunReport report = runs::read_report(own / "report.json");
    const runs::RunReport other = runs::read_report(alone / "report.json");
    const Positions<Dim> start = positions_at<Dim>(scene, alone, 0);
    Difference result;
    for (int step = 1; step <= scene.scene.frames; ++step) {
        const Positions<Dim> a = positions_at<Dim>(scene, own, step);
        const Positions<Dim> b = positions_at<Dim>(scene, alone, step);
        result.last = (a - b).norm() / (b - start).norm();
        result.first = step == 1 ? result.last : result.first;
        result.crossings += crossings_at<Dim>(scene, a) + crossings_at<Dim>(scene, b);
    }
    const StepReport& first = report.steps.at(0);
    const StepReport& first_alone = other.steps.at(0);
    result.energy = energy_difference(first, first_alone);
    result.momentum = momentum_difference(first, first_alone);
    // Behind the first contacts a penalty's kinks make of rounding what they like.
    std::size_t i = 0;
    while (i + 1 < other.steps.size() && !do_contacts_count(other.steps[i])) {
        ++i;
    }
    const simulator::ContactSummary& own_contacts = report.steps.at(i).contact;
    const simulator::ContactSummary& contacts = other.steps[i].contact;
    result.has_same_contacts =
        own_contacts.point_facet == contacts.point_facet && own_contacts.mixed == contacts.mixed
        && own_contacts.self == contacts.self && own_contacts.obstacle == contacts.obstacle;
    result.contacts = contacts_of(other.steps[i]);
    return result;
}

// A row of the table; returns whether all is the same.
bool compare(const Places& places, const QuickScene& scene) {
    const fs::path alone = simulate(places, scene, scene.file, 0);
    std::printf("| %s | %lld", scene.name.c_str(),
                static_cast<long long>(  // NOLINT(google-runtime-int): for printf
                    runs::read_report(alone / "report.json").size.elements));
    const auto beside_alone = [&](const fs::path& file, int ranks) {
        const fs::path own = simulate(places, scene, file, ranks);
        const Difference one = scene.scene.dimension == 3 ? difference<3>(scene, own, alone)
                                                          : difference<4>(scene, own, alone);
        std::printf(" | %.0e", one.first);
        std::fflush(stdout);
        fs::remove_all(own);
        return one;
    };
    Difference worst;
    for (const int ranks : kRanks) {
        worst.take(beside_alone(scene.file, ranks));
    }
    static_cast<void>(beside_alone(scene.nudged, 0));
    fs::remove_all(alone);
    std::printf(" | %.0e | %.0e | %.0e | %lld | %s |\n", worst.last, worst.energy, worst.momentum,
                static_cast<long long>(worst.contacts),  // NOLINT(google-runtime-int)
                worst.is_same()            ? "yes"
                : worst.crossings > 0      ? "CROSSES"
                : !worst.has_same_contacts ? "OTHER CONTACTS"
                                           : "NO");
    std::fflush(stdout);
    return worst.is_same();
}

int compare_all(const Places& places, const std::vector<std::string>& wanted) {
    std::vector<QuickScene> scenes = data_scenes(places);
    for (const auto& more : {muscle_scenes(places), stress_scenes(places)}) {
        scenes.insert(scenes.end(), more.begin(), more.end());
    }
    std::printf("| scene | elements |");
    for (const int ranks : kRanks) {
        std::printf(" %d |", ranks);
    }
    std::puts(" nudged | last step | energies | momenta | contacts | same |");
    std::puts("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    int others = 0;
    for (const QuickScene& scene : scenes) {
        if (wanted.empty() || std::find(wanted.begin(), wanted.end(), scene.name) != wanted.end()) {
            others += compare(places, scene) ? 0 : 1;
        }
    }
    return others == 0 ? 0 : 1;
}

}  // namespace
}  // namespace pent::test

int main(int argc, char** argv) {
    if (argc < 4) {
        std::fputs("usage: ranks_equality PROGRAMS DATA WORK [SCENE...]\n", stderr);
        return 2;
    }
    try {
        const pent::test::Places places{std::filesystem::canonical(argv[1]),
                                        std::filesystem::canonical(argv[2]),
                                        std::filesystem::absolute(argv[3])};
        std::filesystem::create_directories(places.work);
        return pent::test::compare_all(places, {argv + 4, argv + argc});
    } catch (const std::exception& error) {
        std::fprintf(stderr, "ranks_equality: %s\n", error.what());
        return 1;
    }
}
