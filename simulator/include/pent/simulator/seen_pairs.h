#pragma once

#include <pent/simulator/scene.h>

#include <cstddef>
#include <utility>
#include <vector>

namespace pent::simulator {

/// Which bodies of a scene with [contact] see each other: what `self`, `ignore`, `only` and
/// attachments say together. Their names, which are all of bodies that are there (see check()), are
/// looked up once.
class SeenPairs {
public:
    explicit SeenPairs(const Scene& scene);

    /// Whether two bodies, or one with itself, see each other, by their places in the scene.
    [[nodiscard]] bool may_touch(std::size_t a, std::size_t b) const;

private:
    using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;  // low, high; ascending

    Pairs apart_;  // by `ignore` and by attachments
    Pairs only_;
    bool do_all_;  // see each other but for those apart: there is no `only`
    bool do_selves_;
};

}  // namespace pent::simulator
