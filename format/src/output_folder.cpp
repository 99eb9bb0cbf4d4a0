#include "pent/output_folder.h"

#include <pent/error.h>
#include <pent/file_lock.h>
#include <pent/output_file.h>
#include <pent/printable.h>
#include <pent/read_text.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <optional>
#include <system_error>
#include <utility>

namespace pent {

namespace {

namespace fs = std::filesystem;

struct List {
    std::string kind;
    std::set<std::string> names;
    bool is_whole = true;  // ends with a whole line
};

std::string first_line(const std::string& kind) {
    return "# pent " + kind
           + ": what the program wrote here, a name a line; --force replaces these files alone";
}

// Whether a name stays within the folder. A list is a file that anybody can edit; the file system
// would take a name with a zero byte in it for its beginning.
bool is_inside(const fs::path& name) {
    return !name.empty() && name.is_relative() && name.native().find('\0') == std::string::npos
           && std::none_of(name.begin(), name.end(),
                           [](const fs::path& part) { return part == ".." || part == "."; });
}

bool is_folder_name(const std::string& name) {
    return name.back() == '/';
}

std::optional<List> read_list(const fs::path& folder) {
    const fs::path path = folder / kFolderList;
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) {
        return std::nullopt;
    }
    const std::string text = read_text(path, "the list of the files of a folder");
    constexpr std::string_view kStart = "# pent ";
    const std::size_t colon = text.find(':');
    List list;
    if (text.rfind(kStart, 0) != 0 || colon > text.find('\n')) {
        return std::nullopt;  // a file of the user's that has this name
    }
    list.kind = text.substr(kStart.size(), colon - kStart.size());
    for (std::size_t at = text.find('\n') + 1; at < text.size();) {
        const std::size_t end = text.find('\n', at);
        if (end == std::string::npos) {  // half a line: the file it was to name was not begun
            list.is_whole = false;
            break;
        }
        const std::string name = text.substr(at, end - at);
        if (!is_inside(name)) {
            throw Error(path.string() + ": \"" + printable(name)
                        + "\" is not a name within the folder; put the list right or remove it");
        }
        list.names.insert(name);
        at = end + 1;
    }
    return list;
}

// ".NAME.PID.tmp", as OutputFile names what it has not finished.
std::string finished_name(const fs::path& temporary) {
    const std::string name = temporary.filename().string();
    const std::string stem = temporary.stem().string();  // without .tmp
    const std::size_t dot = stem.rfind('.');
    const bool has_form = temporary.extension() == ".tmp" && name.front() == '.' && dot > 0
                          && dot + 1 < stem.size()
                          && stem.find_first_not_of("0123456789", dot + 1) == std::string::npos;
    return has_form ? stem.substr(1, dot - 1) : "";
}

bool has_nothing(const fs::path& folder) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
        if (finished_name(entry.path()) != kFolderList) {
            return false;
        }
    }
    if (error) {
        throw Error(folder.string() + ": cannot be read: " + error.message()
                    + "; choose a folder that you may read and write");
    }
    return true;
}

// Folders that a name is in, from the innermost, as far as they are empty.
void remove_empty_parents(const fs::path& folder, const fs::path& name) {
    std::error_code ignored;
    for (fs::path parent = name.parent_path(); !parent.empty(); parent = parent.parent_path()) {
        fs::remove(folder / parent, ignored);  // fails for one that has something in it
    }
}

void remove_entry(const fs::path& folder, const std::string& name);

// What the list of a folder has, then the folder if nothing else is in it.
void remove_folder(const fs::path& folder) {
    const std::optional<List> list = read_list(folder);
    if (!list) {
        return;
    }
    for (const std::string& name : list->names) {
        remove_entry(folder, name);
    }
    std::error_code ignored;
    const auto count = std::distance(fs::directory_iterator(folder), fs::directory_iterator());
    if (count == 1) {
        fs::remove(folder / kFolderList, ignored);
        fs::remove(folder, ignored);
    }
}

void remove_entry(const fs::path& folder, const std::string& name) {
    if (is_folder_name(name)) {
        remove_folder(folder / name);
        remove_empty_parents(folder, fs::path(name).parent_path());
        return;
    }
    std::error_code error;
    const fs::path path = folder / name;
    if (fs::is_directory(fs::symlink_status(path, error))) {
        return;  // somebody's folder in the place of our file
    }
    fs::remove(path, error);
    if (error) {
        throw Error(path.string() + ": cannot be removed: " + error.message());
    }
    remove_empty_parents(folder, name);
}

void refuse_inputs(const fs::path& folder,
                   const std::set<std::string>& names,
                   const std::vector<fs::path>& inputs) {
    for (const std::string& name : names) {
        const fs::path path = folder / name;
        if (is_folder_name(name)) {
            if (const std::optional<List> list = read_list(path)) {
                refuse_inputs(path, list->names, inputs);
            }
            continue;
        }
        for (const fs::path& input : inputs) {
            std::error_code ignored;
            if (fs::equivalent(input, path, ignored)) {
                throw Error(input.string()
                            + ": is read, and would be replaced with the rest of what is in "
                            + folder.string() + "; use another folder, or a copy of the file");
            }
        }
    }
}

}  // namespace

OutputFolder::OutputFolder(fs::path path, std::string kind)
    : path_(std::move(path)), kind_(std::move(kind)) {
    std::error_code ignored;
    const fs::file_status status = fs::status(path_, ignored);
    if (!fs::exists(status)) {
        return;
    }
    if (!fs::is_directory(status)) {
        throw Error(path_.string() + ": is a file; expected a folder, or a name for a new one");
    }
    std::optional<List> list = read_list(path_);
    if (!list) {
        is_foreign_ = !has_nothing(path_);
        return;
    }
    if (list->kind != kind_) {
        throw Error(path_.string() + ": is the folder of a " + list->kind + ", not of a " + kind_
                    + "; use another folder");
    }
    names_ = std::move(list->names);
    has_list_ = true;
    if (!list->is_whole) {
        lock();
        write_list();
    }
}

OutputFolder::~OutputFolder() = default;
OutputFolder::OutputFolder(OutputFolder&&) noexcept = default;
OutputFolder& OutputFolder::operator=(OutputFolder&&) noexcept = default;

// What another program did between our look and now would be lost in our list.
void OutputFolder::lock() {
    if (lock_ != nullptr) {
        return;
    }
    make_folder(path_);
    lock_ = std::make_unique<FileLock>(path_,
                                       "another program is writing to this folder; wait until it"
                                       " is done, or use another folder",
                                       FileLockOptions{.is_shared = is_shared_});
    const std::optional<List> list = read_list(path_);
    if ((list ? list->names : std::set<std::string>()) != names_) {
        throw Error(path_.string()
                    + ": another program has just written to this folder; try again, or use another"
                      " folder");
    }
}

void OutputFolder::write_list() const {
    std::string text = first_line(kind_) + "\n";
    for (const std::string& name : names_) {
        text += name + "\n";
    }
    write_text(path_ / kFolderList, text);
}

void OutputFolder::refuse_foreign() const {
    if (is_foreign_) {
        throw Error(path_.string() + ": has files in it that no " + kind_
                    + " of ours wrote (it has no " + kFolderList
                    + "), and stays as it is; use another folder, or an empty one");
    }
}

fs::path OutputFolder::claim(const std::string& name) {
    const fs::path path = path_ / name;
    lock();
    if (names_.count(name) != 0) {
        make_folder(path.parent_path());  // may have been removed
        return path;
    }
    std::error_code ignored;
    if (fs::exists(fs::symlink_status(path, ignored))) {
        throw Error(path.string() + ": is there, and was not written by the " + kind_
                    + " in this folder; move it away or use another folder");
    }
    adopt(name);
    make_folder(is_folder_name(name) ? path.parent_path().parent_path() : path.parent_path());
    return path;
}

void OutputFolder::adopt(const std::string& name) {
    lock();
    if (names_.count(name) != 0) {
        return;
    }
    if (is_shared_) {
        throw Error((path_ / kFolderList).string() + ": does not list " + name
                    + ", which other programs that write to this folder must know of");
    }
    names_.insert(name);
    if (has_list_) {
        append_text(path_ / kFolderList, name + "\n");
    } else {
        write_list();
        has_list_ = true;
    }
}

void OutputFolder::remove(const std::string& name) {
    if (names_.count(name) != 0) {
        lock();
        remove_entry(path_, name);
    }
}

void OutputFolder::share() {
    lock_.reset();
    is_shared_ = true;
    lock();
}

void OutputFolder::clear(const std::vector<fs::path>& inputs) {
    assert(!is_shared_);
    refuse_inputs(path_, names_, inputs);
    lock();
    remove_temporaries();
    for (const std::string& name : names_) {
        remove_entry(path_, name);
    }
    if (has_list_) {
        // Folders in which somebody else's files are left stay, and stay ours to write to.
        std::error_code ignored;
        std::erase_if(names_, [&](const std::string& name) {
            return !is_folder_name(name) || !fs::exists(path_ / name, ignored);
        });
        write_list();
    }
}

void OutputFolder::remove_temporaries() {
    lock();
    std::set<fs::path> folders = {""};
    for (const std::string& name : names_) {
        folders.insert(fs::path(name).parent_path());
    }
    for (const fs::path& folder : folders) {
        std::error_code ignored;
        std::vector<fs::path> left;
        for (const auto& entry : fs::directory_iterator(path_ / folder, ignored)) {
            const std::string name = finished_name(entry.path());
            if (!name.empty()
                && (names_.count((folder / name).string()) != 0 || name == kFolderList)) {
                left.push_back(entry.path());
            }
        }
        for (const fs::path& path : left) {
            fs::remove(path, ignored);
        }
    }
}

}  // namespace pent
