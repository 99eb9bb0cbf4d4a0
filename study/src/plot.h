#pragma once

#include "drawing.h"

#include <pent/study/study.h>

namespace pent::study {

/// Error against seconds per frame, both logarithmic: every result a dot, colored by its value on
/// one axis of the study, with a curve for each color through those that no other of it beats; the
/// frontier of all as a black line, its dots numbered and listed beside; the reference's cost as a
/// vertical and its error bar as a horizontal dashed line.
[[nodiscard]] Drawing frontier_plot(const StudyReport& report);

}  // namespace pent::study
