#pragma once

#include "http.h"

#include <filesystem>
#include <string>

namespace pent::viewer {

/// What a browser may see of a disk: the page of web/, and one run or mesh. Nothing else, whatever
/// it asks for.
///
///     /                          the page
///     /playground.js             what it loads when its playground is opened, if it is built
///     /NAME/run.json             bodies and frames there are now, whether more may come, and
///                                whether obstacles are "none", "still" or "moving"
///     /NAME/meshes/BODY.pent     files of the run NAME; also frames/, scene.toml, report.json,
///                                obstacles.json, obstacles/
///     /NAME/NAME                 in place of a run: a mesh, or a model (.g4b, .g4tf), which
///                                run.json names
///     /NAME/BUFFER               a file that the model has numbers in, in its folder or below
class RunSite {
public:
    /// @param page  index.html as scripts/web.sh builds it.
    /// @param run   A run folder, a .pent mesh, or a model of other programs.
    /// Throws an Error if one of them is not what it should be.
    RunSite(const std::filesystem::path& page, const std::filesystem::path& run);

    /// @param port  That the request came to: its Host must be this machine's own with this port,
    /// so
    ///              that pages of others cannot read the run by a name that leads here.
    [[nodiscard]] HttpResponse answer(const HttpRequest& request, int port) const;

    /// What stands behind the host in the address that shows the run: "/?run=octopus/"; of a file
    /// "/?run=octopus.pent/".
    [[nodiscard]] std::string start() const;

private:
    [[nodiscard]] HttpResponse file_of_run(const std::string& name) const;
    [[nodiscard]] HttpResponse buffer_of_model(const std::string& name) const;
    [[nodiscard]] HttpResponse listing() const;

    std::filesystem::path run_;  // without links
    bool is_single_file_ = false;
    std::string name_;  // of the run
    std::string page_;  // its bytes
    std::filesystem::path playground_;
};

}  // namespace pent::viewer
