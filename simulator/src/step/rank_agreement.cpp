#include "step/rank_agreement.h"

#include "model/near_cells.h"
#include "model/partition.h"

#include <pent/crc32c.h>
#include <pent/dimensions.h>
#include <pent/error.h>

#include <algorithm>
#include <exception>
#include <new>
#include <utility>
#include <vector>

namespace pent::simulator {

namespace {

template <typename Matrix>
std::uint32_t checksum(const Matrix& matrix, std::uint32_t before) {
    return crc32c(matrix.data(),
                  static_cast<std::size_t>(matrix.size()) * sizeof(typename Matrix::Scalar),
                  before);
}

// One number of each rank.
std::vector<double> list(const Ranks& ranks, double own) {
    const std::vector<std::int64_t> ones(static_cast<std::size_t>(ranks.count()), 1);
    return ranks.gather({&own, 1}, ones);
}

}  // namespace

Isa choose_isa(const std::string& name, const Ranks* ranks) {
    if (name.empty() && ranks != nullptr) {
        const std::vector<double> all = list(*ranks, static_cast<double>(best_isa()));
        return static_cast<Isa>(static_cast<int>(*std::min_element(all.begin(), all.end())));
    }
    if (name.empty()) {
        return best_isa();
    }
    for (const Isa isa : {Isa::Scalar, Isa::Baseline, Isa::Avx2, Isa::Avx512}) {
        if (name == isa_name(isa)) {
            if (!is_supported(isa)) {
                // GCOVR_EXCL_START: a machine that has all of them
                throw Error("the instruction set " + name + " is not supported by this machine; "
                            + std::string(isa_name(best_isa())) + " is");
                // GCOVR_EXCL_STOP
            }
            return isa;
        }
    }
    throw Error("the instruction set \"" + name
                + "\" is not known; expected scalar, baseline, avx2 or avx512");
}

template <int Dim>
Bodies<Dim> share(const Scene& scene,
                  Bodies<Dim> bodies,
                  const std::shared_ptr<const Ranks>& ranks) {
    if (ranks != nullptr) {
        bodies.sharing = Sharing(
            ranks,
            partition_columns<Dim>(bodies.rest(), number_columns(bodies.meshes), ranks->count()));
        refuse_others(ranks.get(), checksum(bodies.cells(), checksum(bodies.rest(), 0)),
                      "other meshes", "let all of them read the same files");
        bodies.may_couple_anything = do_terms_couple_anything(scene);
        keep_near_cells(scene.solver.elements, bodies);
    }
    return bodies;
}

template <int Dim>
void refuse_disagreement(const Sharing& sharing,
                         const Positions<Dim>& positions,
                         std::uint64_t step) {
    if (sharing.is_shared()) {
        refuse_others(&sharing.ranks(), checksum(positions, 0),
                      "other positions at step " + std::to_string(step),
                      "run one build on processors of one kind");
    }
}

void refuse_others(const Ranks* ranks,
                   std::uint32_t checksum,
                   const std::string& what,
                   const std::string& advice) {
    const std::vector<double> all =
        ranks != nullptr ? list(*ranks, checksum) : std::vector<double>();
    for (std::size_t rank = 1; rank < all.size(); ++rank) {
        if (all[rank] != all[0]) {
            throw Error("rank " + std::to_string(rank) + " has " + what + " than rank 0; "
                        + advice);
        }
    }
}

bool any(const Ranks& ranks, bool is_so) {
    const std::vector<double> all = list(ranks, is_so ? 1 : 0);
    return std::find(all.begin(), all.end(), 1.0) != all.end();
}

void agree(const Ranks* ranks, const std::function<void()>& work) {
    if (ranks == nullptr) {
        work();
        return;
    }
    std::string failure;
    bool has_failed = true;
    try {
        work();
        has_failed = false;
    } catch (const std::bad_alloc&) {
        failure = "rank " + std::to_string(ranks->rank()) + ": out of memory";
    } catch (const std::exception& error) {
        failure = error.what();
    }
    const double size = has_failed ? static_cast<double>(failure.size()) + 1 : 0;
    const std::vector<double> sizes = list(*ranks, size);
    const auto first = std::find_if(sizes.begin(), sizes.end(), [](double s) { return s > 0; });
    if (first == sizes.end()) {
        return;
    }
    // Text travels as numbers, for which there is a way: it is rare, and short.
    std::vector<std::int64_t> lengths(sizes.size(), 0);
    lengths[static_cast<std::size_t>(first - sizes.begin())] =
        static_cast<std::int64_t>(*first) - 1;
    const bool is_first = ranks->rank() == first - sizes.begin();
    const std::vector<double> own(failure.begin(), is_first ? failure.end() : failure.begin());
    const std::vector<double> letters = ranks->gather(own, lengths);
    std::string text;
    for (const double letter : letters) {
        text += static_cast<char>(letter);
    }
    throw Error(text);
}

#define PENT_INSTANTIATE(Dim)                                                                   \
    template Bodies<Dim> share(const Scene&, Bodies<Dim>, const std::shared_ptr<const Ranks>&); \
    template void refuse_disagreement(const Sharing&, const Positions<Dim>&, std::uint64_t);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
