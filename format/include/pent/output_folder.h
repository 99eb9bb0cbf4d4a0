#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace pent {

class FileLock;

/// The list of an OutputFolder, within it.
inline constexpr const char* kFolderList = "written.txt";

/// A folder of which a program knows what it wrote there. The names of its files stand in
/// FOLDER/written.txt, each from before it is written, so that they do after a kill at any moment
/// too; nothing else in the folder is ever replaced or removed.
///
///     # pent run: what the program wrote here, a name a line; --force replaces these files alone
///     scene.toml
///     frames/box_000000.pent
///     runs/fine/                    a folder with a list of its own
///
/// Every function throws an Error that names the path where a file cannot be read or written. From
/// the first one that changes something on, no other program may change anything in the folder.
class OutputFolder {
public:
    /// Looks at a folder and writes nothing. Throws an Error if the path is not a folder, or if its
    /// list is of another kind or damaged.
    ///
    /// @param kind  What the folder holds, as in "run": of folders of another kind nothing is
    ///              touched.
    OutputFolder(std::filesystem::path path, std::string kind);
    ~OutputFolder();
    OutputFolder(OutputFolder&&) noexcept;
    OutputFolder& operator=(OutputFolder&&) noexcept;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

    /// Neither a folder with a list nor an empty one: what is in it is somebody else's.
    [[nodiscard]] bool is_foreign() const { return is_foreign_; }

    /// Whether the folder has a list.
    [[nodiscard]] bool has_list() const { return has_list_; }

    /// Throws an Error that says what to do if is_foreign().
    void refuse_foreign() const;

    /// The path of a file that the program may write from now on; makes its folder. Throws an Error
    /// if there is such a file that is not listed.
    ///
    /// @param name  Relative to the folder; with '/' at its end a folder with a list of its own,
    ///              which is
    ///              not made.
    std::filesystem::path claim(const std::string& name);

    /// Lists a file that is known to be the program's, as one that an older version wrote without a
    /// list.
    void adopt(const std::string& name);

    /// Removes a listed file, or of a listed folder what its list has. Does nothing for what is not
    /// listed.
    void remove(const std::string& name);

    /// Lets other programs that share it, too, write to the folder from now on, each to files of
    /// its own that are listed already: none can be listed any more. Throws an Error if a program
    /// has the folder for itself.
    void share();

    /// Removes everything listed, and folders that are empty then. Throws an Error before it
    /// removes anything if one of `inputs` is among it.
    void clear(const std::vector<std::filesystem::path>& inputs);

    /// Removes what a killed program left half written: `.NAME.PID.tmp` beside a listed NAME.
    void remove_temporaries();

private:
    void lock();
    void write_list() const;

    std::filesystem::path path_;
    std::string kind_;
    std::set<std::string> names_;
    bool has_list_ = false;
    bool is_foreign_ = false;
    std::unique_ptr<FileLock> lock_;  // from the first change on
    bool is_shared_ = false;
};

}  // namespace pent
