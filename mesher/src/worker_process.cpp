#include "worker_process.h"

#include <pent/error.h>

#include <algorithm>
#include <array>

namespace pent::mesher {

namespace {

std::string tail(std::FILE* file) {
    std::array<char, 4096> buffer{};
    std::fseek(file, 0, SEEK_END);
    const auto size = std::ftell(file);
    const auto length = std::min<decltype(size)>(size, buffer.size());
    std::fseek(file, size - length, SEEK_SET);
    return {buffer.data(), std::fread(buffer.data(), 1, static_cast<std::size_t>(length), file)};
}

}  // namespace

ProcessResult run_process(const std::filesystem::path& program,
                          const std::vector<std::string>& arguments,
                          std::FILE* input,
                          std::FILE* output) {
    const File log = temporary_file();
    ChildProcess child(
        program, arguments,
        {.input = ::fileno(input), .output = ::fileno(output), .errors = ::fileno(log.get())});
    const ChildEnd end = child.wait();
    return {.exit_code = end.exit_code, .signal = end.signal, .log = tail(log.get())};
}

std::filesystem::path find_helper(const std::string& name) {
    const std::filesystem::path folder =
        std::filesystem::read_symlink("/proc/self/exe").parent_path();
    const std::filesystem::path beside = folder / name;
    if (std::filesystem::exists(beside)) {
        return beside;
    }
    const std::filesystem::path installed = folder.parent_path() / "libexec" / "pent" / name;
    if (std::filesystem::exists(installed)) {
        return installed;
    }
    throw Error(name + ": not found as " + beside.string() + " or " + installed.string()
                + "; build or install it with the mesher");
}

}  // namespace pent::mesher
