#pragma once

#include "common/program.h"
#include "common/progress.h"
#include "common/same_file.h"

#include <pent/viewer/coloring.h>
#include <pent/viewer/project.h>
#include <pent/viewer/section.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pent::apps {

/// What pent-slice and pent-render have in common on their command lines, as written there.
struct ViewArguments {
    std::string input;
    std::vector<std::string> w;
    std::string normal;
    std::vector<std::string> offsets;
    std::vector<std::string> rotations;
    std::string frames;
    std::string projection;
    std::string eye;
    std::string color = "body";
};

void add_view_options(CLI::App& cli, ViewArguments& arguments);

/// What is read of `input`, a mesh or a run, for Program::require_apart(): of a run the scene,
/// report, obstacles, meshes, frames, contacts and checkpoints, and its folder, but nothing else in
/// that.
[[nodiscard]] std::vector<NamedFile> inputs_of(const std::string& input);

/// `file` itself, for Program::require_apart() to refuse, if it is in `folder` and called as what
/// the program writes there; an empty path if not.
/// @param names  A regular expression for the whole of such a name.
[[nodiscard]] NamedFile taken_name(const std::filesystem::path& file,
                                   const std::filesystem::path& folder,
                                   const std::string& names);

/// The hyperplanes meant. Throws an Error that says what was found and what was expected.
[[nodiscard]] viewer::SectionOptions to_sections(const ViewArguments& arguments);

/// The projection meant, if any. Throws an Error as to_sections does.
[[nodiscard]] std::optional<viewer::ProjectionOptions> to_projection(
    const ViewArguments& arguments);

/// Shows the progress of slicing and rendering, a line for each kind of work.
class WorkProgress {
public:
    explicit WorkProgress(bool quiet) : quiet_(quiet) {}

    /// As viewer::OnProgress; false once the user asked to stop.
    [[nodiscard]] bool operator()(std::string_view what, std::int64_t done, std::int64_t total);

    /// Ends the line.
    void finish() { line_.reset(); }

private:
    bool quiet_;
    std::string what_;
    std::unique_ptr<Progress> line_;
};

/// Numbers with commas between. Throws an Error that begins with `what`.
[[nodiscard]] std::vector<double> to_numbers(const std::string& text, const std::string& what);

}  // namespace pent::apps
