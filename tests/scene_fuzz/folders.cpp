#include "folders.h"

#include "child.h"

#include <algorithm>
#include <set>
#include <sstream>
#include <utility>

namespace pent::scene_fuzz {

namespace {

namespace fs = std::filesystem;

constexpr const char* kReport = "report.json";
constexpr const char* kJournal = "journal.txt";

std::set<std::string> files_in(const fs::path& folder) {
    std::set<std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.is_regular_file()) {
            files.insert(fs::relative(entry.path(), folder).string());
        }
    }
    return files;
}

void remove_keys(Json& tree, const std::set<std::string>& keys) {
    if (tree.is_object()) {
        for (const std::string& key : keys) {
            tree.erase(key);
        }
    }
    if (tree.is_structured()) {
        for (Json& entry : tree) {
            remove_keys(entry, keys);
        }
    }
}

// The first place where two trees differ.
std::string tree_difference(const Json& a, const Json& b, const std::string& path) {
    if (a == b) {
        return "";
    }
    if (a.is_array() && b.is_array() && a.size() == b.size()) {
        for (std::size_t i = 0; i < a.size(); ++i) {
            if (a[i] != b[i]) {
                return tree_difference(a[i], b[i], path + "[" + std::to_string(i) + "]");
            }
        }
    }
    if (a.is_object() && b.is_object()) {
        for (const auto& [key, value] : a.items()) {
            if (!b.contains(key) || b[key] != value) {
                return tree_difference(value, b.value(key, Json()), path + "." + key);
            }
        }
    }
    const auto brief = [](const Json& value) { return value.dump().substr(0, 100); };
    return path + ": " + brief(a) + " and " + brief(b);
}

// The entries of a journal, without the checksums of its lines: they change with the seconds.
Json read_journal(const fs::path& run, Apart apart) {
    constexpr std::size_t kChecksum = 9;
    Json entries = Json::array();
    std::istringstream lines(text_of_file(run / kJournal));
    for (std::string line; std::getline(lines, line);) {
        Json entry = Json::parse(line.substr(std::min(kChecksum, line.size())));
        const bool is_of_part = entry.contains("part") || entry.contains("end");
        if (apart == Apart::Times || !is_of_part) {
            entries.push_back(std::move(entry));
        }
    }
    return entries;
}

std::string statistics_difference(const fs::path& a, const fs::path& b, Apart apart) {
    std::set<std::string> keys = {"seconds", "threads", "assembly_seconds", "solve_seconds",
                                  "ccd_seconds"};
    if (apart == Apart::TimesAndWork) {
        keys.insert({"parts", "searches", "candidates", "trees_built", "trees_refit", "bytes",
                     "contact_bytes", "matrix_blocks"});
    }
    const auto difference = [&](const std::string& file, Json first, Json second) {
        remove_keys(first, keys);
        remove_keys(second, keys);
        return tree_difference(first, second, file);
    };
    const std::string of_reports = difference(kReport, read_report(a), read_report(b));
    return !of_reports.empty()
               ? of_reports
               : difference(kJournal, read_journal(a, apart), read_journal(b, apart));
}

}  // namespace

Json read_report(const fs::path& run) {
    return Json::parse(text_of_file(run / kReport));
}

Json value_at(const Json& tree, const std::string& path) {
    const Json* at = &tree;
    for (std::size_t begin = 0; begin <= path.size();) {
        const std::size_t end = std::min(path.find('.', begin), path.size());
        const std::string key = path.substr(begin, end - begin);
        if (!at->is_object() || !at->contains(key)) {
            return {};
        }
        at = &(*at)[key];
        begin = end + 1;
    }
    return *at;
}

std::string first_difference(const fs::path& a, const fs::path& b, Apart apart) {
    const std::set<std::string> files = files_in(a);
    const std::set<std::string> others = files_in(b);
    for (const std::string& file : files) {
        if (!others.contains(file)) {
            return file + " is missing in " + b.filename().string();
        }
        if (file == kReport || file == kJournal) {
            continue;
        }
        if (text_of_file(a / file) != text_of_file(b / file)) {
            return file + " differs";
        }
    }
    for (const std::string& file : others) {
        if (!files.contains(file)) {
            return file + " is only in " + b.filename().string();
        }
    }
    return statistics_difference(a, b, apart);
}

}  // namespace pent::scene_fuzz
