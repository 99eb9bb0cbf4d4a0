#pragma once

#include <pent/contact/contact_model.h>
#include <pent/obstacle.h>
#include <pent/simulator/material.h>
#include <pent/simulator/solver_options.h>
#include <pent/simulator/words.h>

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace pent::simulator {

/// What to simulate, as plain data. Every vector has `Scene::dimension` entries, axes x y z w.
///
/// read_scene() fills a Scene from a file and checks it; a host program may as well fill one
/// itself.

/// A plane of rotation: by a positive angle, axis `from` turns towards axis `to`.
struct Plane {
    int from = 0;
    int to = 1;
};

/// One rotation of a placement.
struct Turn {
    Plane plane;
    double degrees = 0;
};

/// One rotation of a motion; turns at a constant rate.
struct Spin {
    Plane plane;
    double degrees_per_s = 0;
};

/// Where a mesh goes: scaled, then turned about the mesh's origin in the order given, then moved.
struct Placement {
    double scale = 1;  ///< > 0.
    std::vector<Turn> rotate;
    Eigen::VectorXd translate;  ///< m.
};

struct Body {
    std::string name;  ///< Letters, digits, '-' and '_': part of file names.
    std::string mesh;  ///< Path of a .pent file.
    Placement place;
    Material material;
    Eigen::VectorXd velocity;  ///< At the start, m/s; empty is zero.
    std::string recipe;  ///< Arguments of pent-mesh that make the mesh, paths relative to the scene
                         ///< file; for pent-study. The simulator does not use it.
    std::vector<Spin> spin;  ///< At the start, about the center of mass, added to the velocity.
    double friction =
        std::numeric_limits<double>::infinity();  ///< Coulomb's coefficient, >= 0; infinite: that
                                                  ///< of Contact.
    std::string source =
        {};  ///< Where its mesh stands in a scene file, as in "scene.toml:4:8", for messages;
             ///< empty if the scene was not read from a file.
};

/// Points at most `radius` from `center`.
struct BallSelection {
    Eigen::VectorXd center;  ///< m.
    double radius = 0;       ///< m, > 0.
};

/// Points between two corners, borders included.
struct BoxSelection {
    Eigen::VectorXd low;   ///< m.
    Eigen::VectorXd high;  ///< m; not below `low` along any axis.
};

/// Points p with normal . p <= offset.
struct HalfSpaceSelection {
    Eigen::VectorXd normal;  ///< Unit length.
    double offset = 0;       ///< m.
};

/// Vertices of the extrusion layers first..last of a mesh that knows its layers.
struct LayerSelection {
    std::uint32_t first = 0;
    std::uint32_t last = 0;
};

/// Vertices of the cells with one region label.
struct RegionSelection {
    std::uint16_t region = 0;
};

/// Every vertex of the body, which makes it fully kinematic.
struct EverythingSelection {};

using Selection = std::variant<BallSelection,
                               BoxSelection,
                               HalfSpaceSelection,
                               LayerSelection,
                               RegionSelection,
                               EverythingSelection>;

/// How selected vertices move: turned about `about` while it is carried along.
///
/// With s = the time within [from, to], less `from`, a vertex at X is taken to
/// about + s translate + R(s) (X - about), R(s) being the spins applied in the order given. No
/// translation and no spin holds the vertices where they are.
struct Motion {
    Eigen::VectorXd translate;  ///< m/s.
    std::vector<Spin> rotate;
    /// m; if absent the mean of the selected vertices, where they are at `from`.
    std::optional<Eigen::VectorXd> about;
    double from = 0;                                      ///< s, >= 0.
    double to = std::numeric_limits<double>::infinity();  ///< s, > from.
};

/// Prescribes the motion of some vertices of a body, selected on placed positions at t = 0, in all
/// steps that begin at `from` or later and before `to`; they are free in all others. One that begins
/// later than the scene takes the vertices on from where they are then.
struct Constraint {
    std::string body;
    std::vector<Selection> select;  ///< A union.
    /// Each takes the vertices on from where those before it have them; none holds them still. A
    /// motion begins no sooner than the constraint.
    std::vector<Motion> motion;
    double from = 0;                                      ///< s, >= 0.
    double to = std::numeric_limits<double>::infinity();  ///< s, > from.
    std::string source = {};  ///< Where its selection stands in a scene file; as Body::source.
};

/// A factor at a time.
struct Keyframe {
    double time = 0;  ///< s, >= 0.
    double factor = 1;
};

/// Something that pushes a body from outside, on what is selected on placed positions at t = 0.
struct Load {
    std::string body;
    std::vector<Selection> select;  ///< A union.
    /// N, of constant direction: of all selected vertices together, each with a part like its mass.
    Eigen::VectorXd force = {};  ///< Empty is none.
    /// N/m^(Dim-1), against the outward normals, as they are now, of the facets of the boundary of
    /// which every vertex is selected.
    double pressure = 0;
    std::vector<Keyframe> keyframes = {};  ///< What both are multiplied by; none: 1.
    std::string source = {};  ///< Where its selection stands in a scene file; as Body::source.
};

/// What becomes of the way from a selected vertex to what it is tied to.
enum class RestOffset {
    Keep,  ///< It is that of t = 0, and moves along with what the vertex is tied to.
    Zero,  ///< None: the spring pulls the two together.
};

/// Ties vertices of a body, selected on placed positions at t = 0, by a spring each: to the points
/// of another body that are nearest then, to one point, or to where they are. Points in space may
/// move.
struct Attachment {
    std::string body;
    std::vector<Selection> select;  ///< A union.
    std::string target = {};        ///< Another body; empty: points in space.
    std::optional<Eigen::VectorXd>
        point;  ///< m: one for all vertices; absent: where each of them is at t = 0.
    std::vector<Motion> motion;  ///< Of points in space, as of a Constraint.
    RestOffset offset = RestOffset::Keep;
    double max_distance = 0.05;  ///< m, > 0: of a vertex from its nearest point of `target`.
    double stiffness = 1000;     ///< N/m for each selected vertex, > 0.
    double damping = 0;          ///< N s/m for each selected vertex, >= 0.
    double from = 0;             ///< s, >= 0: of steps that begin before it is not there.
    double to = std::numeric_limits<double>::infinity();  ///< s, > from: of those from here on.
    double break_force =
        std::numeric_limits<double>::infinity();  ///< N, > 0: a spring that pulls harder is gone.
    bool contact = true;      ///< Whether [contact] is between the two bodies all the same.
    std::string source = {};  ///< Where its selection stands in a scene file; as Body::source.
};

/// Shapes of obstacles, with vectors of the scene's dimension: <pent/obstacle.h>.
using HalfSpaceObstacle = pent::HalfSpace<Eigen::Dynamic>;
using BallObstacle = pent::Ball<Eigen::Dynamic>;
using CavityObstacle = pent::Cavity<Eigen::Dynamic>;
using BowlObstacle = pent::Bowl<Eigen::Dynamic>;
using BoxObstacle = pent::Cuboid<Eigen::Dynamic>;
using ObstacleShape = pent::Obstacle<Eigen::Dynamic>;

/// Something no body may enter; it moves as it is told, or not at all.
///
/// Every free vertex nearer than `distance` to it, or inside it, has the energy
/// stiffness (distance - d)^2, d being the signed distance: a force that grows linearly with depth.
struct Obstacle {
    ObstacleShape shape;
    double distance = 0.02;   ///< m, > 0.
    double stiffness = 1000;  ///< N/m for each vertex, > 0.
    /// One after the other, as of a Constraint; each turns it about its center (a half-space about
    /// its point next to the origin) unless it says otherwise. A box does not turn.
    std::vector<Motion> motion = {};
};

/// How bodies that touch push each other; a barrier not with the linear Euler integrator.
using contact::ContactModel;

/// Two bodies by their names, in any order; one twice for what it does to itself.
struct BodyPair {
    std::string first;
    std::string second;
};

/// Contact between bodies, and within them if asked.
struct Contact {
    ContactModel model = ContactModel::Penalty;
    double distance = 0.02;   ///< m, > 0: how near is in contact; a quarter of an edge is good.
    double stiffness = 1000;  ///< N/m for each pair, > 0; a barrier raises it where it has to.
    bool self = false;        ///< Whether bodies meet themselves.
    Filter filter = Filter::Clamp;
    double separation = 0;     ///< m, >= 0: a distance that a barrier never lets be reached.
    double friction = 0;       ///< Coulomb's coefficient, >= 0; of bodies and obstacles. Of two
                               ///< with coefficients of their own it is the geometric mean.
    double slip_speed = 1e-3;  ///< m/s, > 0: what slides slower than that sticks.
    std::vector<BodyPair> ignore = {};  ///< Pairs that do not see each other.
    std::vector<BodyPair> only = {};    ///< If there are any, no other pair sees each other.
};

/// What frames may have of every vertex beside its position and velocity.
enum class VertexQuantity {
    ContactForce,   ///< Of contact and obstacles, N.
    Reaction,       ///< What a constraint holds its vertices with against all forces, N; else 0.
    EnergyDensity,  ///< Elastic, J/m^Dim: of the cells around, by their volume at rest.
};
template <>
inline constexpr std::array kWords<VertexQuantity> = {
    Word<VertexQuantity>{VertexQuantity::ContactForce, "contact_force"},
    Word<VertexQuantity>{VertexQuantity::Reaction, "reaction"},
    Word<VertexQuantity>{VertexQuantity::EnergyDensity, "energy_density"},
};

/// What a run writes beside positions and velocities.
struct Output {
    std::vector<VertexQuantity> vertex = {};  ///< In the frame files.
    bool contact_pairs = false;               ///< Every pair in contact, in a table for each frame.
};

/// Rayleigh damping: C = mass M + stiffness K, K being the tangent at the start of a step.
struct Damping {
    double mass = 0;       ///< 1/s, >= 0.
    double stiffness = 0;  ///< s, >= 0.
};

/// Bodies at rest that are not solved for until something moves them.
///
/// A body falls asleep, its velocities set to zero, when for a while it and all it touches have
/// been slow, asleep, or held still. It wakes when its held vertices move, or when it touches what
/// moves.
struct Sleep {
    double speed = 1e-3;  ///< Of the fastest vertex, in diagonals of the box around the body a
                          ///< second, > 0: slower counts as at rest.
    double time = 0.5;    ///< s, > 0: how long a body has to be at rest.
};

struct Scene {
    int dimension = 4;        ///< 3 or 4.
    Eigen::VectorXd gravity;  ///< m/s^2.
    int frames = 100;         ///< After frame 0, which is the start; > 0.
    double frames_per_second = 30;
    int steps_per_frame = 1;
    std::vector<Body> bodies;
    std::vector<Constraint> constraints;
    std::vector<Load> loads;
    std::vector<Attachment> attachments;
    std::vector<Obstacle> obstacles;
    std::optional<Contact> contact;  ///< Absent: bodies pass through one another, at no cost.
    std::optional<Damping> damping;  ///< Absent: not modeled.
    std::optional<Sleep> sleep;      ///< Absent: all bodies are solved for all the time.
    SolverOptions solver;
    Output output;

    /// Length of a time step, s.
    [[nodiscard]] double dt() const { return 1.0 / (frames_per_second * steps_per_frame); }
};

/// The place of a body among those of a scene, which has one of this name.
[[nodiscard]] std::uint32_t index_of(const Scene& scene, const std::string& body);

/// Whether two bodies of a scene with [contact], or one with itself, see each other, by their
/// places: what `self`, `ignore`, `only` and attachments say together.
[[nodiscard]] bool may_touch(const Scene& scene, std::size_t a, std::size_t b);

/// "xw" for {0, 3}.
[[nodiscard]] std::string plane_name(const Plane& plane);

/// Throws an Error that names the entry unless every number is in its range, vectors have the
/// scene's dimension, names are unique and valid, and constraints name bodies of the scene.
void check(const Scene& scene);

}  // namespace pent::simulator
