#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace pent::apps {

/// What is wrong with a command line, in one line: at which option, what was found and what
/// belongs there in the words of --help, or which option was probably meant. CLI11 has the names
/// of types alone, as in "--w: 1 required C missing".
[[nodiscard]] std::string usage_error(const CLI::App& cli, const CLI::ParseError& error);

/// The same of an option that took the next one for its value, as in "--w -o OUT", which CLI11
/// takes for a place called "-o"; empty where there is none. To be asked of a line that was parsed,
/// too: "-o --quiet" would be a folder of that name, which "-o ./--quiet" still is.
[[nodiscard]] std::string swallowed_option(const CLI::App& cli);

}  // namespace pent::apps
