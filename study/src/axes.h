#pragma once

#include <pent/simulator/scene.h>
#include <pent/study/study.h>

#include <string>
#include <vector>

namespace pent::study {

/// One thing that is varied, and the values it takes.
struct Axis {
    std::string name = {};
    std::vector<std::string> values = {};
};

/// "dt=1/30,1/60" as an axis. A path of a key that has a name of its own comes out as that:
/// "solver.tolerance" as "tolerance". Commas part values, but not within a list or a table. Throws
/// an Error unless there is a name and values, none twice.
[[nodiscard]] Axis parse_axis(const std::string& text);

/// Every combination of the values of the axes, the last axis fastest; one without settings if
/// there are no axes.
[[nodiscard]] std::vector<Settings> combinations(const std::vector<Axis>& axes);

/// Whether an axis changes the mesh: layers or subdivide.
[[nodiscard]] bool is_mesh_axis(const std::string& name);

/// The scene with settings: dt, preset, contact (its model), keys of [solver], and the paths of
/// others, as in "attachment.stiffness" (runs::with_keys()), in any order. A preset stands in place
/// of all of [solver], and other settings on it. Axes of the mesh leave the scene as it is.
///
/// dt must divide the time between two frames into whole steps. Throws an Error as check_setting()
/// does, and for settings that do not go together, as a barrier and linear_euler.
[[nodiscard]] simulator::Scene with_settings(simulator::Scene scene, const Settings& settings);

/// Throws an Error for an unknown axis (with the nearest known one), a value that the schema of
/// scenes does not have whatever the others are, and a block that the scene does not have.
void check_setting(simulator::Scene scene, const Setting& setting);

/// "1/60" or "0.01" in seconds. Throws an Error unless it is a positive number.
[[nodiscard]] double parse_seconds(const std::string& text);

/// A name for files: settings_text() with only letters, digits, '-', '_' and '.'.
[[nodiscard]] std::string file_name(const Settings& settings);

}  // namespace pent::study
