#include "child.h"

#include <pent/error.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace pent::scene_fuzz {

namespace {

constexpr int kRefused = 90;
constexpr int kThrew = 91;
constexpr int kClockPerProcessor = 10;

// Beside what the work has printed.
std::filesystem::path message_path(const std::filesystem::path& log) {
    return log.string() + ".error";
}

[[noreturn]] void be_child(const std::function<void()>& work,
                           const std::filesystem::path& log,
                           int seconds) {
    const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
    const rlimit time{static_cast<rlim_t>(seconds), static_cast<rlim_t>(seconds) + 1};
    setrlimit(RLIMIT_CPU, &time);
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    alarm(static_cast<unsigned>(kClockPerProcessor * seconds));
    int code = 0;
    try {
        work();
    } catch (const Error& error) {
        std::ofstream(message_path(log)) << error.what();
        code = kRefused;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "an exception that is no pent::Error: %s", error.what());
        code = kThrew;
    }
    std::fflush(nullptr);
    _exit(code);
}

ChildResult broken(const std::string& how, const std::string& printed) {
    return {Ended::Broken, how + (printed.empty() ? "" : "\n" + printed)};
}

}  // namespace

std::string text_of_file(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

ChildResult run_in_child(const std::function<void()>& work,
                         const std::filesystem::path& log,
                         int seconds) {
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child < 0) {
        throw Error(std::string("cannot start a process: ") + std::strerror(errno));
    }
    if (child == 0) {
        be_child(work, log, seconds);
    }
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    const std::string printed = text_of_file(log);
    if (WIFSIGNALED(status)) {
        const int signal = WTERMSIG(status);
        if (signal == SIGKILL) {
            return {Ended::Killed, printed};
        }
        return signal == SIGXCPU || signal == SIGALRM
                   ? broken("took more than " + std::to_string(seconds) + " s", printed)
                   : broken(std::string("ended by signal: ") + strsignal(signal), printed);
    }
    const int code = WEXITSTATUS(status);
    if (code == 0) {
        return {Ended::Well, printed};
    }
    return code == kRefused ? ChildResult{Ended::Refused, text_of_file(message_path(log))}
                            : broken("ended with code " + std::to_string(code), printed);
}

}  // namespace pent::scene_fuzz
