#include <pent/child_process.h>
#include <pent/error.h>

#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

namespace pent {

namespace {

// What a child does before it becomes the program; released in any case.
class SpawnPlan {
public:
    explicit SpawnPlan(const ChildOptions& options) {
        ::posix_spawn_file_actions_init(&actions);
        ::posix_spawnattr_init(&attributes);
        give(options.input, STDIN_FILENO, O_RDONLY);
        give(options.output, STDOUT_FILENO, O_WRONLY);
        give(options.errors, STDERR_FILENO, O_WRONLY);
        if (!options.folder.empty()) {
            ::posix_spawn_file_actions_addchdir_np(&actions, options.folder.c_str());
        }
        if (options.has_own_group) {
            ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
        }
    }
    ~SpawnPlan() {
        ::posix_spawnattr_destroy(&attributes);
        ::posix_spawn_file_actions_destroy(&actions);
    }
    SpawnPlan(const SpawnPlan&) = delete;
    SpawnPlan& operator=(const SpawnPlan&) = delete;
    SpawnPlan(SpawnPlan&&) = delete;
    SpawnPlan& operator=(SpawnPlan&&) = delete;

    posix_spawn_file_actions_t actions{};
    posix_spawnattr_t attributes{};

private:
    void give(int from, int to, int mode) {
        if (from < 0) {
            ::posix_spawn_file_actions_addopen(&actions, to, "/dev/null", mode, 0);
        } else {
            ::posix_spawn_file_actions_adddup2(&actions, from, to);
        }
    }
};

double seconds(const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

std::string reason(int error) {
    return std::generic_category().message(error);
}

}  // namespace

File temporary_file(const std::string& owner) {
    File file(std::tmpfile());
    if (!file) {
        throw Error((owner.empty() ? "" : owner + ": ") + "cannot make a temporary file: "
                    + reason(errno) + "; make room in the folder for temporary files");
    }
    return file;
}

ChildProcess::ChildProcess(const std::filesystem::path& program,
                           const std::vector<std::string>& arguments,
                           const ChildOptions& options)
    : name_(program.string()) {
    const bool is_name = !program.has_parent_path();
    // A path is meant from where we are, not from the folder to work in.
    std::vector<std::string> words = {is_name ? program.string()
                                              : std::filesystem::absolute(program).string()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;  // is not written to, and yet not const
    for (std::string& word : words) {
        argv.push_back(word.data());
    }
    argv.push_back(nullptr);
    const SpawnPlan plan(options);
    const auto spawn = is_name ? &::posix_spawnp : &::posix_spawn;
    const int failure =
        spawn(&id_, words[0].c_str(), &plan.actions, &plan.attributes, argv.data(), environ);
    if (failure != 0) {
        throw Error(name_ + ": cannot be started: " + reason(failure));
    }
}

ChildProcess::~ChildProcess() {
    try {
        static_cast<void>(wait());
    } catch (const Error&) {
        return;  // it has ended all the same
    }
}

std::optional<ChildEnd> ChildProcess::wait(int options) {
    int status = 0;
    rusage usage{};
    pid_t ended = -1;
    do {
        ended = ::wait4(id_, &status, options, &usage);
    } while (ended < 0 && errno == EINTR);
    if (ended < 0) {
        throw Error(name_ + ": cannot be waited for: " + reason(errno));
    }
    if (ended == 0) {
        return std::nullopt;
    }
    end_ = {.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 0,
            .signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0,
            .cpu_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime)};
    return end_;
}

std::optional<ChildEnd> ChildProcess::poll() {
    return end_ ? end_ : wait(WNOHANG);
}

ChildEnd ChildProcess::wait() {
    return end_ ? *end_ : *wait(0);
}

void ChildProcess::stop() const {
    if (!end_) {
        ::kill(id_, SIGTERM);
    }
}

}  // namespace pent
