#pragma once

#include <pent/output_folder.h>
#include <pent/simulator/scene.h>
#include <pent/study/study.h>

#include <cstdint>
#include <filesystem>
#include <functional>

namespace pent::study {

/// What the list of a study's folder calls it; see OutputFolder.
inline constexpr const char* kStudyFolder = "study";

/// The arguments of pent-mesh for a body at a level of the mesh axes: those of its recipe, with
/// --layers and --subdivide of the settings in place of its own.
[[nodiscard]] std::vector<std::string> mesh_arguments(const std::string& recipe,
                                                      const Settings& settings);

/// The scene with the meshes of a level: bodies with a recipe get meshes made by pent-mesh in
/// `folder`; those that are there and
/// were made from the same are used again. A scene whose own meshes are there keeps them if
/// the settings have no axis of the mesh. Paths come out absolute.
///
/// Throws an Error if a mesh is missing and there is no recipe, if the settings have an axis of the
/// mesh and no body has a recipe, and if pent-mesh fails.
///
/// @param folder  That of the study.
[[nodiscard]] simulator::Scene with_meshes(const simulator::Scene& scene,
                                           const Settings& settings,
                                           const StudyOptions& options,
                                           OutputFolder& folder,
                                           const std::function<bool()>& should_stop);

/// A checksum over the checksums of the mesh files of all bodies.
[[nodiscard]] std::uint32_t mesh_checksum(const simulator::Scene& scene);

}  // namespace pent::study
