#pragma once

#include "study_folder.h"

#include <pent/study/units.h>

#include <filesystem>
#include <string>
#include <vector>

namespace pent::study {

struct ChildOutcome;

/// Runs units of a study by pent-sim, one after the other.
class UnitRunner {
public:
    /// Folder and callbacks must live longer than this.
    ///
    /// @param programs  Folder with pent-sim. Throws an Error unless it is the one that the study
    ///                  was prepared with.
    UnitRunner(StudyFolder& study, std::filesystem::path programs, const StudyCallbacks& callbacks);

    /// Runs what is not done of these, by their places in the plan. Throws Stopped, and an Error as
    /// study::run_unit() does.
    ///
    /// @return  How the last of them ended.
    UnitOutcome run(const std::vector<std::size_t>& units);

private:
    [[nodiscard]] bool is_stopping() const;
    [[nodiscard]] int runs_of(const Unit& unit) const;
    void tell(int run, const std::string& next) const;
    [[nodiscard]] ChildOutcome simulate(const UnitFiles& files, bool resume) const;
    void run_level(UnitFiles& files);
    void run_combination(UnitFiles& files);
    void run_once(UnitFiles& files);

    StudyFolder& study_;
    std::filesystem::path programs_;
    const StudyCallbacks& callbacks_;
    int runs_done_ = 0;
    int runs_ = 0;
};

}  // namespace pent::study
