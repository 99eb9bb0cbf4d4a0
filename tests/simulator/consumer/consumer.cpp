#include <pent/runs/scene_file.h>
#include <pent/simulator/simulation.h>

// One pentachoron in free fall for a step.
int main() {
    pent::SimplexMesh<4> mesh;
    mesh.positions = pent::Positions<4>::Zero(4, 5);
    mesh.positions.rightCols<4>().setIdentity();
    mesh.cells = pent::Simplices<5>{{0}, {1}, {2}, {3}, {4}};
    const auto scene = pent::runs::parse_scene(
        "scene = { gravity = [0, -9, 0, 0] }\nbody = { name = 'a', mesh = '' }", "scene", "");
    pent::simulator::Simulation<4> simulation(scene, {mesh});
    return simulation.step().is_accepted && simulation.positions(0)(1, 0) < 0 ? 0 : 1;
}
