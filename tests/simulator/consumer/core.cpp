#include <pent/simulator/simulation.h>

// One pentachoron in free fall for a step, its scene filled in by the host.
int main() {
    pent::SimplexMesh<4> mesh;
    mesh.positions = pent::Positions<4>::Zero(4, 5);
    mesh.positions.rightCols<4>().setIdentity();
    mesh.cells = pent::Simplices<5>{{0}, {1}, {2}, {3}, {4}};
    pent::simulator::Body body;
    body.name = "a";
    body.place.translate = Eigen::Vector4d::Zero();
    body.material.lame = pent::simulator::lame_from_young(4, 1e5, 0.28);
    pent::simulator::Scene scene;
    scene.gravity = Eigen::Vector4d(0, -9, 0, 0);
    scene.bodies = {body};
    pent::simulator::Simulation<4> simulation(scene, {mesh});
    return simulation.step().is_accepted && simulation.positions(0)(1, 0) < 0 ? 0 : 1;
}
