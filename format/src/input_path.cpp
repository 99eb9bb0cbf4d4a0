#include <pent/error.h>
#include <pent/input_path.h>

#include <algorithm>
#include <cctype>
#include <system_error>

namespace pent {

std::string format_of(const std::filesystem::path& path, const std::string& given) {
    std::string ending = given.empty() ? path.extension().string() : "." + given;
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending;
}

std::string input_name(const std::filesystem::path& path) {
    return path.string() == kStandardInput ? "standard input" : path.string();
}

void refuse_folder(const std::filesystem::path& path) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) {
        throw Error(path.string() + ": is a folder; give a file");
    }
}

void require_file(const std::filesystem::path& path) {
    if (path.string() == kStandardInput) {
        return;
    }
    std::error_code error;
    const bool is_there = std::filesystem::exists(path, error);
    if (error) {
        throw Error(path.string() + ": cannot be opened: " + error.message());
    }
    if (!is_there) {
        throw Error(path.string() + ": no such file");
    }
    refuse_folder(path);
}

}  // namespace pent
