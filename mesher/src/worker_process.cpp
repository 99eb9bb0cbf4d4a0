#include "worker_process.h"

#include <pent/error.h>

#include <array>
#include <cerrno>
#include <spawn.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

namespace pent::mesher {

namespace {

std::string reason(int error) {
    return std::generic_category().message(error);
}

// The descriptors a child gets, released in any case.
class FileActions {
public:
    FileActions() { ::posix_spawn_file_actions_init(&actions_); }
    ~FileActions() { ::posix_spawn_file_actions_destroy(&actions_); }
    FileActions(const FileActions&) = delete;
    FileActions& operator=(const FileActions&) = delete;
    FileActions(FileActions&&) = delete;
    FileActions& operator=(FileActions&&) = delete;

    void give(std::FILE* file, int descriptor) {
        ::posix_spawn_file_actions_adddup2(&actions_, ::fileno(file), descriptor);
    }
    [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &actions_; }

private:
    posix_spawn_file_actions_t actions_{};
};

std::string tail(std::FILE* file) {
    std::array<char, 4096> buffer{};
    std::fseek(file, 0, SEEK_END);
    const auto size = std::ftell(file);
    const auto length = std::min<decltype(size)>(size, buffer.size());
    std::fseek(file, size - length, SEEK_SET);
    return {buffer.data(), std::fread(buffer.data(), 1, static_cast<std::size_t>(length), file)};
}

}  // namespace

File temporary_file() {
    File file(std::tmpfile());
    if (!file) {
        throw Error("cannot make a temporary file: " + reason(errno)
                    + "; make room in the folder for temporary files");
    }
    return file;
}

ProcessResult run_process(const std::filesystem::path& program,
                          const std::vector<std::string>& arguments,
                          std::FILE* input,
                          std::FILE* output) {
    const File log = temporary_file();
    FileActions actions;
    actions.give(input, STDIN_FILENO);
    actions.give(output, STDOUT_FILENO);
    actions.give(log.get(), STDERR_FILENO);
    std::string name = program.string();
    std::vector<std::string> copies = arguments;  // the child's argv is not const
    std::vector<char*> argv{name.data()};
    for (std::string& argument : copies) {
        argv.push_back(argument.data());
    }
    argv.push_back(nullptr);
    pid_t child = 0;
    const int error =
        ::posix_spawn(&child, name.c_str(), actions.get(), nullptr, argv.data(), environ);
    if (error != 0) {
        throw Error(name + ": cannot be started: " + reason(error));
    }
    int status = 0;
    while (::waitpid(child, &status, 0) < 0) {
        if (errno != EINTR) {
            throw Error(name + ": cannot be waited for: " + reason(errno));
        }
    }
    ProcessResult result;
    result.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
    result.log = tail(log.get());
    return result;
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
