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
std::string worst(const Extreme& extreme, Precision precision) {
    Outcome worst;
    for (const Asked& asked : asked_of(extreme)) {
        if (asked.precision != precision) {
            continue;
        }
        const Outcome outcome = run(extreme, asked.motion, precision);
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
    heading("Numbers", "elements and number", "value");
    for (const ElementKind elements : {ElementKind::Linear, ElementKind::Quadratic}) {
        std::vector<Case> all = cases();
        if (elements == ElementKind::Linear) {
            all.push_back(million());
        }
        std::string group;
        for (const Case& one : all) {
            const Extreme extreme = with_elements(one.extreme, elements);
            const bool is_in_float = is_right_in_float(extreme);
            row(one.group == group ? "" : std::string(word_of(elements)) + ", " + one.group,
                one.name,
                !one.is_inside ? "out"
                : is_in_float  ? "in"
                               : "in double",
                [&](Precision precision) { return worst(extreme, precision); });
            group = one.group;
        }
    }
}

// A motion of corners of one kind of elements, within the box or outside.
struct Corners {
    ElementKind elements;
    Motion motion;
    bool is_inside;
};

// Those that are asked for it.
std::vector<Case> asked_corners(const Corners& what, Precision precision) {
    std::vector<Case> all;
    for (Case corner : corners()) {
        corner.extreme = with_elements(corner.extreme, what.elements);
        const std::vector<Asked> asked = asked_of_corner(corner.extreme);
        const bool is_asked = std::any_of(asked.begin(), asked.end(), [&](const Asked& one) {
            return one.motion == what.motion && one.precision == precision;
        });
        if (is_asked && drowns_inertia(corner.extreme) != what.is_inside) {
            all.push_back(corner);
        }
    }
    return all;
}

// "112 right, up to 1e-4; 16 reported".
std::string counted(const Corners& what, Precision precision) {
    Outcome worst;
    int right = 0;
    int reported = 0;
    for (const Case& corner : asked_corners(what, precision)) {
        const Outcome outcome = run(corner.extreme, what.motion, precision);
        if (outcome.kind == Outcome::Kind::Wrong) {
            return "at " + corner.name + ": " + text(outcome);
        }
        const bool is_right = outcome.kind == Outcome::Kind::Right;
        (is_right ? right : reported) += 1;
        worst.error = std::max(worst.error, outcome.error);
    }
    if (right == 0) {
        return reported == 0 ? "not asked" : std::to_string(reported) + " reported";
    }
    return std::to_string(right) + " " + text(worst)
           + (reported == 0 ? "" : "; " + std::to_string(reported) + " reported");
}

void write_corners() {
    constexpr const char* kNames[] = {"fall", "fall by newton_euler", "turn", "load", "rest"};
    heading("Corners", "elements and motion", "corners");
    for (const ElementKind elements : {ElementKind::Linear, ElementKind::Quadratic}) {
        for (const Motion motion : kMotions) {
            std::string name =
                std::string(word_of(elements)) + ", " + kNames[static_cast<int>(motion)];
            for (const bool is_inside : {true, false}) {
                const Corners what{elements, motion, is_inside};
                const auto count = asked_corners(what, Precision::Double).size();
                if (count > 0) {
                    row(name, std::to_string(count), is_inside ? "in" : "out",
                        [&](Precision precision) { return counted(what, precision); });
                    name = "";
                }
            }
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
