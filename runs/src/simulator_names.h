#pragma once

#include <pent/simulator/crossing_error.h>
#include <pent/simulator/rigid_fit.h>
#include <pent/simulator/scene.h>
#include <pent/simulator/simulation.h>

namespace pent::runs {

// What this library speaks of all the time.
using simulator::Activation;
using simulator::Attachment;
using simulator::AttachmentSummary;
using simulator::Body;
using simulator::Constraint;
using simulator::ContactModel;
using simulator::ContactSettings;
using simulator::ContactSummary;
using simulator::CrossingError;
using simulator::Damping;
using simulator::ElementKind;
using simulator::EverythingSelection;
using simulator::Integrator;
using simulator::lame_from_young;
using simulator::LinearSolverKind;
using simulator::Load;
using simulator::Material;
using simulator::Motion;
using simulator::non_rigid;
using simulator::Obstacle;
using simulator::ObstacleShape;
using simulator::Output;
using simulator::Plane;
using simulator::Region;
using simulator::RegionSelection;
using simulator::RegionSummary;
using simulator::Scene;
using simulator::Selection;
using simulator::Simulation;
using simulator::SimulationSize;
using simulator::SleepState;
using simulator::Snapshot;
using simulator::SolverOptions;
using simulator::Spin;
using simulator::StepReport;
using simulator::VertexQuantity;
using simulator::YoungPoisson;

}  // namespace pent::runs
