#pragma once

#include "chunks.h"

#include <pent/contact/team.h>

#include <cstdint>
#include <cstring>
#include <vector>

// Work that a team shares: pieces go round, and what is found is gathered in an order that does not
// depend on who found it.

namespace pent::contact {

/// The part of one process in the work of a team; all of it where there is none. Items are plain
/// values, without pointers.
class SharedWork {
public:
    SharedWork() = default;

    /// @param team  Null for one process alone; must outlive this.
    explicit SharedWork(const Team* team) : team_(team) {}

    [[nodiscard]] bool is_shared() const { return team_ != nullptr; }

    /// Whether a piece, counted from 0, is of this process.
    [[nodiscard]] bool is_own(std::size_t piece) const {
        return team_ == nullptr || piece % team_->count() == team_->rank();
    }

    /// The lists of all, by rank.
    template <typename Item>
    [[nodiscard]] std::vector<std::vector<Item>> lists(std::vector<Item> own) const {
        std::vector<std::vector<Item>> all;
        if (team_ == nullptr) {
            all.push_back(std::move(own));
            return all;
        }
        for (const std::vector<std::byte>& bytes :
             team_->gather(std::as_bytes(std::span<const Item>(own)))) {
            std::vector<Item>& list = all.emplace_back(bytes.size() / sizeof(Item));
            if (!bytes.empty()) {  // vectors of Eigen are plain, too, but do not say so
                std::memcpy(static_cast<void*>(list.data()), bytes.data(), bytes.size());
            }
        }
        return all;
    }

    /// The same one after the other.
    template <typename Item>
    [[nodiscard]] std::vector<Item> all(std::vector<Item> own) const {
        return team_ == nullptr ? std::move(own) : joined(lists(std::move(own)));
    }

    [[nodiscard]] std::int64_t sum(std::int64_t own) const {
        std::int64_t total = 0;
        for (const std::int64_t part : all(std::vector<std::int64_t>{own})) {
            total += part;
        }
        return total;
    }

    /// As collect() of one alone, each chunk by one of the team.
    template <typename Item, typename Add>
    [[nodiscard]] std::vector<Item> collect(std::size_t count,
                                            std::size_t size,
                                            const Add& add) const {
        if (team_ == nullptr) {
            return contact::collect<Item>(count, size, add);
        }
        std::vector<std::vector<Item>> chunks((count + size - 1) / size);
        for_each_chunk(count, size, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; is_own(chunk) && i < end; ++i) {
                add(i, chunks[chunk]);
            }
        });
        std::vector<std::uint64_t> sizes;
        for (std::size_t chunk = team_->rank(); chunk < chunks.size(); chunk += team_->count()) {
            sizes.push_back(chunks[chunk].size());
        }
        const std::vector<std::vector<std::uint64_t>> all_sizes = lists(std::move(sizes));
        const std::vector<std::vector<Item>> found = lists(joined(std::move(chunks)));
        return in_order(all_sizes, found);
    }

private:
    // Chunks went round, so the next of each list in turn.
    template <typename Item>
    static std::vector<Item> in_order(const std::vector<std::vector<std::uint64_t>>& sizes,
                                      const std::vector<std::vector<Item>>& found) {
        std::vector<Item> all;
        std::vector<std::size_t> next(found.size(), 0);
        for (std::size_t turn = 0; turn < sizes.front().size(); ++turn) {
            for (std::size_t rank = 0; rank < found.size() && turn < sizes[rank].size(); ++rank) {
                const auto begin = found[rank].begin() + static_cast<std::ptrdiff_t>(next[rank]);
                next[rank] += sizes[rank][turn];
                all.insert(all.end(), begin,
                           found[rank].begin() + static_cast<std::ptrdiff_t>(next[rank]));
            }
        }
        return all;
    }

    const Team* team_ = nullptr;
};

}  // namespace pent::contact
