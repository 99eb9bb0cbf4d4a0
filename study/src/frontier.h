#pragma once

#include <pent/study/study.h>

#include <string>
#include <vector>

namespace pent::study {

/// The results that finished and that no other beats in both seconds per frame and position error,
/// the fastest first. A gain in error below a twentieth counts as none, and errors below
/// `error_bar` count as equal to it: the reference cannot tell them apart.
[[nodiscard]] std::vector<std::size_t> frontier_of(const std::vector<Result>& results,
                                                   double error_bar);

/// For error levels of 20, 10, 5, 2, 1, 0.5, 0.2 and 0.1 %, as far as they differ in what they
/// choose: "within 1%: dt=1/60 integrator=bdf2, 0.9 s per frame, 14x faster than the reference
/// (error 0.6%)".
[[nodiscard]] std::vector<std::string> sentences_of(const StudyReport& report);

/// "0.013%", "1.2%", "340%".
[[nodiscard]] std::string percent(double fraction);

/// A number with three digits.
[[nodiscard]] std::string short_number(double value);

/// The middle value, or the mean of the two in the middle; 0 of none.
[[nodiscard]] double median(std::vector<double> values);

}  // namespace pent::study
