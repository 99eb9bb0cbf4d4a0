#pragma once

#include "study_folder.h"

#include <pent/study/study.h>

#include <string>

namespace pent::study {

/// Compares what has not been compared, and writes the files of the study. Throws an Error that
/// names the units that are missing, and how to run them.
[[nodiscard]] StudyReport collect(StudyFolder& study, const std::string& created_by);

/// Numbers in rising order as people write them: "1, 4-7, 9".
[[nodiscard]] std::string ranges_text(const std::vector<int>& numbers);

}  // namespace pent::study
