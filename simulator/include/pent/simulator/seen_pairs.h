#pragma once

#include <pent/simulator/scene.h>

#include <cstddef>
#include <utility>
#include <vector>

namespace pent::simulator {

/// Which bodies of a scene with [contact] may touch: what `self`, `ignore`, `only` and attachments
/// say together. Names are looked up once; all of them have to be those of bodies, see check().
class SeenPairs {
public:
    explicit SeenPairs(const Scene& scene);

    /// Whether two bodies, or one with itself, may touch, by their places in the scene.
    [[nodiscard]] bool may_touch(std::size_t a, std::size_t b) const;

private:
    using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;  // low, high; ascending

    Pairs apart_;  // that may not touch, by `ignore` and by attachments
    Pairs only_;
    bool do_all_;  // whether all others may: there is no `only`
    bool do_selves_;
};

}  // namespace pent::simulator
