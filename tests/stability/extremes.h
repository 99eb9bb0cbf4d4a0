#pragma once

#include <pent/simulator/scene.h>

#include <string>
#include <vector>

namespace pent::stability {

/// How far out a simulation can go: tables of cases, which the tests judge and docs/stability.md
/// shows. A case changes some numbers of a small body and asks for motions whose end is known.

/// The numbers of a case. Lengths of the body are multiples of `size`, so that a case is one thing.
struct Extreme {
    double poisson = 0.28;
    double young = 1e5;     ///< Pa.
    double density = 1000;  ///< kg/m^4.
    double dt = 1.0 / 30;   ///< s.
    double aspect = 1;      ///< Thickness of layers over the other edges.
    double ratio = 1;       ///< Young's modulus of a second body over that of the first.
    double heaviness = 1;   ///< Density of a second body over that of the first.
    double size = 1;        ///< m.
    double offset = 0;      ///< Distance of the body from the origin, in sizes.
    double gravity = 9.8;   ///< m/s^2.
    int cells = 2;          ///< Tesseracts along the body; 0 for a single pentachoron.
    int across = 1;         ///< Tesseracts along each of the other axes.
    double newton_tolerance = 1e-6;
    simulator::ElementKind elements = simulator::ElementKind::Linear;
    int turn_steps = 6;  ///< That a turn is taken in.
    int threads = 1;
};

struct Case {
    std::string group;      ///< As in "Poisson's ratio".
    std::string name;       ///< As in "-0.5".
    bool is_inside = true;  ///< Of the box in which every case has to be right.
    Extreme extreme = {};
};

/// Everything that is tried.
[[nodiscard]] const std::vector<Case>& cases();

/// Whether stiffness times the square of the time step is more than 1e8 masses of a vertex.
/// Quadratic elements have vertices at half of the distance.
[[nodiscard]] bool drowns_inertia(const Extreme& extreme);

/// The corners of the box, every number at one of its ends, all at once. They have to be right
/// where their elements do not drown inertia.
[[nodiscard]] const std::vector<Case>& corners();

/// A body of a million pentachora: for the report alone, too slow for a test.
[[nodiscard]] Case million();

/// What is asked of every case. Each has an exact answer that depends on nothing but the motion
/// told.
enum class Motion {
    Fall,  ///< Nothing held, implicit Euler: x = x0 + g h^2 n (n + 1) / 2 after n steps, exactly.
    Descend,  ///< The same by Newton's method.
    Turn,     ///< One end turned by 60 degrees in two planes, quasistatic: the body turns rigidly.
    Load,     ///< A single pentachoron on a held facet, its corner pulled along and across by its
              ///< weight, quasistatic: stable neo-Hookean gives the corner's place in closed form.
    Rest,     ///< One end held, no gravity, a velocity of zero: nothing moves at all.
};
inline constexpr Motion kMotions[] = {Motion::Fall, Motion::Descend, Motion::Turn, Motion::Load,
                                      Motion::Rest};

/// An extreme with other elements. Quadratic ones bend: where layers are thin, a turn is taken by a
/// degree a step in place of ten, by which they fold.
[[nodiscard]] Extreme with_elements(Extreme extreme, simulator::ElementKind elements);

/// What a case, with its elements, is run with.
struct Asked {
    Motion motion;
    simulator::Precision precision;
};

/// What is asked of a case: all motions but, of quadratic elements, the load, since one of them
/// does not deform evenly by its weight.
[[nodiscard]] std::vector<Asked> asked_of(const Extreme& extreme);

/// What is asked of a corner: all that, and less of quadratic elements, which take their time.
/// Where inertia drowns, a fall in double; and turns once for all that statics does not know of or
/// scales with, in double where layers are thin.
[[nodiscard]] std::vector<Asked> asked_of_corner(const Extreme& extreme);

/// Whether a number within the box has to be right also in float: a turn of thin layers of
/// quadratic elements needs double.
[[nodiscard]] bool is_right_in_float(const Extreme& extreme);

struct Outcome {
    enum class Kind { Right, Refused, Reported, Wrong } kind = Kind::Right;
    double error = 0;    ///< Largest distance from the answer over the body's size and travel.
    std::string reason;  ///< Of Refused (the scene is not accepted) and Reported (a step fails).
};

/// Largest error that counts as right, by precision of the matrix.
[[nodiscard]] double bound(simulator::Precision precision);

/// Runs a case; never throws for what a simulation may do with its numbers.
[[nodiscard]] Outcome run(const Extreme& extreme, Motion motion, simulator::Precision precision);

/// States to come back from: how a body starts that is at rest and held at one end, and whether
/// stable neo-Hookean is known to bring it back by Newton's method (see collapse_scale()).
struct Start {
    std::string name;
    bool comes_back = true;            ///< With linear elements.
    bool quadratic_comes_back = true;  ///< With quadratic ones.
};
[[nodiscard]] const std::vector<Start>& starts();

/// Lets go of a damped body at a start; Right with the final distance from rest as error.
[[nodiscard]] Outcome run(const Start& start,
                          simulator::ElementKind elements,
                          simulator::Integrator integrator,
                          simulator::Precision precision);

/// Two bodies and contact at its extremes. Right if momentum is kept, which is the error, no
/// coordinate leaves the world, and with a barrier nothing crosses. Penalties promise less:
/// Reported where vertices end deeper in the other body than they began, as StepReport says.
struct Touch {
    std::string name;
    double gap = 0.05;      ///< Between the bodies, edges; negative: they overlap.
    double distance = 0.1;  ///< Of contact, edges.
    double shift = 0.3;     ///< Of the second along the others' faces, edges; 0: exactly parallel.
    double ratio = 1;       ///< Young's modulus of the second over that of the first.
    double speed = 0;       ///< Of the second towards the first, edges a second.
    int cells = 1;          ///< As in Extreme.
};
/// Of quadratic elements, whose children are many, without those that take minutes: contact over
/// half an edge or more, and the fastest.
[[nodiscard]] std::vector<Touch> touches(simulator::ElementKind elements);
[[nodiscard]] Outcome run(const Touch& touch,
                          simulator::ElementKind elements,
                          simulator::ContactModel model,
                          simulator::Precision precision);

/// "right, 1e-9", "refused: ...", "reported: ...", "WRONG, 0.1".
[[nodiscard]] std::string text(const Outcome& outcome);

}  // namespace pent::stability
