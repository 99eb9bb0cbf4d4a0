#pragma once

#include <pent/parallel.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

// Loops in chunks of a fixed size, whatever the number of threads, with results in the order of the
// chunks: the same bits for any number of threads.

namespace pent::contact {

/// Calls work(chunk, begin, end) for the chunks of [0, count).
template <typename Work>
void for_each_chunk(std::size_t count, std::size_t size, const Work& work) {
    parallel_for((count + size - 1) / size, [&](std::size_t chunk) {
        work(chunk, chunk * size, std::min((chunk + 1) * size, count));
    });
}

/// All lists in one.
template <typename Item>
[[nodiscard]] std::vector<Item> joined(std::vector<std::vector<Item>> parts) {
    if (parts.size() == 1) {
        return std::move(parts[0]);
    }
    std::size_t count = 0;
    for (const std::vector<Item>& part : parts) {
        count += part.size();
    }
    std::vector<Item> all;
    all.reserve(count);
    for (const std::vector<Item>& part : parts) {
        all.insert(all.end(), part.begin(), part.end());
    }
    return all;
}

/// What add(i, list) adds to a list for all i in [0, count), in their order: a list for each chunk.
template <typename Item, typename Add>
[[nodiscard]] std::vector<std::vector<Item>> collect_parts(std::size_t count,
                                                           std::size_t size,
                                                           const Add& add) {
    std::vector<std::vector<Item>> parts((count + size - 1) / size);
    for_each_chunk(count, size, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            add(i, parts[chunk]);
        }
    });
    return parts;
}

/// The same in one list.
template <typename Item, typename Add>
[[nodiscard]] std::vector<Item> collect(std::size_t count, std::size_t size, const Add& add) {
    return joined(collect_parts<Item>(count, size, add));
}

}  // namespace pent::contact
