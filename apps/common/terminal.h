#pragma once

namespace pent::apps {

/// Whether stdout is a terminal that a person looks at, where a line may be written over. Those are
/// none that a launcher of ranks gives its processes: what they say it passes on, maybe to a file.
[[nodiscard]] bool is_on_terminal();

}  // namespace pent::apps
