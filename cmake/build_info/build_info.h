#pragma once

namespace pent {

/// What --version prints behind the name and the version: three lines, of the commit, the compiler
/// and the features that were built.
[[nodiscard]] const char* build_info();

}  // namespace pent
