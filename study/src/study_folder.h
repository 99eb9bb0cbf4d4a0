#pragma once

#include "plan.h"
#include "record.h"
#include "reference.h"

#include <pent/output_folder.h>
#include <pent/simulator/scene.h>

#include <filesystem>
#include <memory>
#include <string>

namespace pent::study {

/// A unit as it is in the folder.
struct UnitFiles {
    const Unit& unit;
    simulator::Scene scene = {};
    Record record = {};     ///< Of its scene, meshes and threads: a fresh one if there was none.
    bool is_begun = false;  ///< There was one.
};

/// A study that has been prepared, as far as its files go.
class StudyFolder {
public:
    /// Both must live longer than this.
    StudyFolder(const Plan& plan, OutputFolder& folder) : plan_(plan), folder_(folder) {}

    [[nodiscard]] const Plan& plan() const { return plan_; }
    [[nodiscard]] OutputFolder& folder() { return folder_; }

    /// NAME and an ending: "", ".toml" or ".json".
    [[nodiscard]] std::filesystem::path path_of(const Unit& unit, const char* ending = "") const;

    /// Throws an Error if the scene is not as it was prepared, and for a record that is damaged.
    /// Not for a unit that is refused.
    [[nodiscard]] UnitFiles open(const Unit& unit) const;

    void write(const UnitFiles& files);

    /// Nothing of it is missing in a collection.
    [[nodiscard]] bool is_done(const Unit& unit) const;
    [[nodiscard]] bool is_done(const UnitFiles& files) const;

    /// Its errors are known.
    [[nodiscard]] bool is_measured(const Record& record) const;

    /// What runs are compared with; null before all of it has been run.
    [[nodiscard]] Reference* reference();

    /// Compares a finished run, whose frames are there, with the reference, writes the record, and
    /// removes the frames unless they are to be kept. Throws an Error as Reference::errors_of().
    void measure(UnitFiles& files);

private:
    const Plan& plan_;
    OutputFolder& folder_;
    std::unique_ptr<Reference> reference_;
};

}  // namespace pent::study
