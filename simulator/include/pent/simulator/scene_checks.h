#pragma once

#include <pent/simulator/scene.h>

#include <optional>
#include <string>
#include <string_view>

namespace pent::simulator {

/// Parts of check(Scene) that several blocks of a scene decide together, so that a reader of scene
/// files can say where. Each throws an Error.

/// What is wrong with the keys of one part taken together.
struct Fault {
    std::string_view key;  ///< Where to say it.
    std::string message;
};

template <typename Part>
[[nodiscard]] std::optional<Fault> fault_of(const Part& /*part*/) {
    return std::nullopt;
}
template <>
[[nodiscard]] std::optional<Fault> fault_of(const BoxSelection& box);
template <>
[[nodiscard]] std::optional<Fault> fault_of(const LayerSelection& layers);
template <>
[[nodiscard]] std::optional<Fault> fault_of(const Load& load);
template <>
[[nodiscard]] std::optional<Fault> fault_of(const Activation& activation);
template <>
[[nodiscard]] std::optional<Fault> fault_of(const Attachment& attachment);
template <>
[[nodiscard]] std::optional<Fault> fault_of(const Motion& motion);
template <>
[[nodiscard]] std::optional<Fault> fault_of(const Constraint& constraint);

/// Whether every region of a body has a name, and each another.
void check_regions(const Body& body);

/// A barrier needs an integrator that iterates.
void check_model(ContactModel model, Integrator integrator);

/// Whether bodies have these names.
void check_pairs(const std::vector<BodyPair>& pairs, const Scene& scene);

/// Smoothed elements know no activation.
void check_activations(const Scene& scene);

/// Where there is no motion nothing can come to rest.
void check_sleeping(Integrator integrator);

/// Every body of a quasistatic scene is held all the time.
void check_held(const Body& body, const Scene& scene);

}  // namespace pent::simulator
