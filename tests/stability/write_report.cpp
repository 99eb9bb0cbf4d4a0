// Prints docs/stability.md: what became of every case, float and double side by side.

#include "extremes.h"

#include <pent/simulator/words.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

namespace {

using namespace pent::stability;
using pent::simulator::ContactModel;
using pent::simulator::ElementKind;
using pent::simulator::Integrator;
using pent::simulator::Precision;

// The worst of the motions of a case.
std::string worst(const Case& one, Precision precision) {
    Outcome worst;
    for (const Motion motion : kMotions) {
        const Outcome outcome = run(one.extreme, motion, precision);
        if (outcome.kind > worst.kind
            || (outcome.kind == worst.kind && outcome.error > worst.error)) {
            worst = outcome;
        }
    }
    return text(worst);
}

template <typename Cell>
void row(const std::string& group, const std::string& name, const char* box, const Cell& cell) {
    std::cout << "| " << group << " | " << name << " | " << box << " | " << cell(Precision::Float)
              << " | " << cell(Precision::Double) << " |\n";
}

void heading(const char* title, const char* first, const char* second) {
    std::cout << "\n## " << title << "\n\n| " << first << " | " << second
              << " | box | float | double |\n| --- | --- | --- | --- | --- |\n";
}

void write_numbers() {
    std::vector<Case> all = cases();
    all.push_back(million());
    std::string group;
    heading("Numbers", "", "value");
    for (const Case& one : all) {
        row(one.group == group ? "" : one.group, one.name, one.is_inside ? "in" : "out",
            [&](Precision precision) { return worst(one, precision); });
        group = one.group;
    }
}

// "112 right, up to 1e-4; 16 reported".
std::string counted(bool is_inside, Motion motion, Precision precision) {
    Outcome worst;
    int right = 0;
    int reported = 0;
    for (const Case& corner : corners()) {
        if (corner.is_inside != is_inside) {
            continue;
        }
        const Outcome outcome = run(corner.extreme, motion, precision);
        if (outcome.kind == Outcome::Kind::Wrong) {
            return "at " + corner.name + ": " + text(outcome);
        }
        const bool is_right = outcome.kind == Outcome::Kind::Right;
        (is_right ? right : reported) += 1;
        worst.error = std::max(worst.error, outcome.error);
    }
    return std::to_string(right) + " " + text(worst)
           + (reported == 0 ? "" : "; " + std::to_string(reported) + " reported");
}

void write_corners() {
    constexpr const char* kNames[] = {"fall", "fall by newton_euler", "turn", "load", "rest"};
    heading("Corners", "motion", "corners");
    for (const Motion motion : kMotions) {
        for (const bool is_inside : {true, false}) {
            const auto count =
                std::count_if(corners().begin(), corners().end(),
                              [&](const Case& one) { return one.is_inside == is_inside; });
            row(is_inside ? kNames[static_cast<int>(motion)] : "", std::to_string(count),
                is_inside ? "in" : "out",
                [&](Precision precision) { return counted(is_inside, motion, precision); });
        }
    }
}

void write_starts() {
    heading("Starts", "elements and integrator", "start");
    for (const ElementKind elements : {ElementKind::Linear, ElementKind::Quadratic}) {
        for (const Integrator integrator : {Integrator::NewtonEuler, Integrator::LinearEuler}) {
            const std::string name =
                std::string(word_of(elements)) + ", `" + std::string(word_of(integrator)) + "`";
            for (const Start& start : starts()) {
                const bool comes_back =
                    elements == ElementKind::Linear ? start.comes_back : start.quadratic_comes_back;
                const bool is_inside = comes_back && integrator == Integrator::NewtonEuler;
                row(&start == starts().data() ? name : "", start.name, is_inside ? "in" : "out",
                    [&](Precision precision) {
                        return text(run(start, elements, integrator, precision));
                    });
            }
        }
    }
}

void write_touches() {
    heading("Contact", "elements and model", "bodies");
    for (const ElementKind elements : {ElementKind::Linear, ElementKind::Quadratic}) {
        for (const ContactModel model : {ContactModel::Penalty, ContactModel::Barrier}) {
            const std::string name = std::string(word_of(elements)) + ", "
                                     + std::string(pent::simulator::word_of(model));
            const std::vector<Touch> all = touches(elements);
            for (const Touch& touch : all) {
                row(&touch == all.data() ? name : "", touch.name, "out", [&](Precision precision) {
                    return text(run(touch, elements, model, precision));
                });
            }
        }
    }
}

}  // namespace

// write_report INTRODUCTION: the text above the tables comes from a file.
int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "write_report: expected the file with the introduction\n");
        return 2;
    }
    std::ifstream introduction(argv[1]);
    std::cout << introduction.rdbuf();
    write_numbers();
    write_corners();
    write_starts();
    write_touches();
    return 0;
}
