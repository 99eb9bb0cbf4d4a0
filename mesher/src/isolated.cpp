#include "isolated.h"

#include "worker_process.h"

#include <pent/error.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <fcntl.h>
#include <new>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace pent::mesher {

namespace {

// What the child's answer begins with; an answer without any of these was cut off.
enum class Answer : std::uint64_t { Result = 1, Error = 2, OutOfMemory = 3 };

struct Header {
    Answer answer = Answer::Result;
    std::int64_t points = 0;
    std::int64_t cells = 0;  // for an error, the length of its text
};

// fwrite() and fread() may not be given a null pointer, which data() of an empty array may be.
template <typename T>
bool write_all(std::FILE* file, const T* data, Eigen::Index count) {
    return count == 0
           || std::fwrite(data, sizeof(T), static_cast<std::size_t>(count), file)
                  == static_cast<std::size_t>(count);
}

template <typename T>
bool read_all(std::FILE* file, T* data, Eigen::Index count) {
    return count == 0
           || std::fread(data, sizeof(T), static_cast<std::size_t>(count), file)
                  == static_cast<std::size_t>(count);
}

// Lowers a limit; the soft one alone: a process that passes the hard one is killed without telling
// which limit it was.
void lower_limit(int resource, rlim_t value) {
    rlimit limit{};
    ::getrlimit(resource, &limit);
    limit.rlim_cur = std::min(limit.rlim_cur, value);
    ::setrlimit(resource, &limit);
}

void prepare_child(const StepLimits& limits, pid_t parent) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) {
        ::_exit(1);  // GCOVR_EXCL_LINE: it ended before we could ask to end with it
    }
    std::signal(SIGINT, SIG_IGN);  // for the parent to decide
    std::signal(SIGTERM, SIG_IGN);
    lower_limit(RLIMIT_CORE, 0);
    lower_limit(RLIMIT_CPU, static_cast<rlim_t>(whole_seconds(limits)));
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they reserve terabytes
    lower_limit(RLIMIT_AS, static_cast<rlim_t>(limits.memory_mib) << 20U);
#endif
    const int nowhere = ::open("/dev/null", O_WRONLY);
    ::dup2(nowhere, STDOUT_FILENO);
    ::dup2(nowhere, STDERR_FILENO);
}

void answer_error(std::FILE* pipe, const std::string& text) {
    const Header header{Answer::Error, 0, static_cast<std::int64_t>(text.size())};
    write_all(pipe, &header, 1);
    write_all(pipe, text.data(), header.cells);
}

template <int Corners>
void answer(std::FILE* pipe,
            const std::string& name,
            const std::function<Pieces<Corners>()>& step) noexcept {
    try {
        const Pieces<Corners> pieces = step();
        const Header header{Answer::Result, pieces.points.cols(), pieces.cells.cols()};
        write_all(pipe, &header, 1);
        write_all(pipe, pieces.points.data(), pieces.points.size());
        write_all(pipe, pieces.cells.data(), pieces.cells.size());
        write_all(pipe, pieces.left_out.data(), kCellKinds);
    } catch (const std::bad_alloc&) {
        const Header header{Answer::OutOfMemory};
        write_all(pipe, &header, 1);
    } catch (const Error& error) {
        answer_error(pipe, error.what());
    } catch (const std::exception& error) {
        std::string text = name + " failed: " + error.what();
        std::replace(text.begin(), text.end(), '\n', ' ');
        answer_error(pipe, text);
    }
    std::fflush(pipe);
}

// What the child says, or nothing if it was cut off. Throws the child's own Error.
template <int Corners>
bool read_answer(std::FILE* pipe,
                 const std::string& name,
                 const StepLimits& limits,
                 Pieces<Corners>& pieces) {
    Header header;
    if (!read_all(pipe, &header, 1)) {
        return false;
    }
    if (header.answer == Answer::OutOfMemory) {
        throw Error(name + " " + explain_out_of_memory(limits));
    }
    if (header.answer == Answer::Error) {
        std::string text(static_cast<std::size_t>(header.cells), ' ');
        read_all(pipe, text.data(), header.cells);
        throw Error(text);
    }
    pieces.points.resize(3, header.points);
    pieces.cells.resize(Corners, header.cells);
    return read_all(pipe, pieces.points.data(), pieces.points.size())
           && read_all(pipe, pieces.cells.data(), pieces.cells.size())
           && read_all(pipe, pieces.left_out.data(), kCellKinds);
}

// Waits for the child in any case, also when its answer was an error.
class Child {
public:
    explicit Child(pid_t id) : id_(id) {}
    ~Child() { static_cast<void>(wait()); }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    Child(Child&&) = delete;
    Child& operator=(Child&&) = delete;

    /// Its status, as waitpid() has it.
    int wait() {
        while (id_ > 0 && ::waitpid(id_, &status_, 0) < 0 && errno == EINTR) {
        }
        id_ = 0;
        return status_;
    }

private:
    pid_t id_;
    int status_ = 0;
};

}  // namespace

std::int64_t whole_seconds(const StepLimits& limits) {
    return std::llround(std::ceil(std::clamp(limits.seconds, 1.0, 1e9)));
}

std::string explain_signal(int signal, const StepLimits& limits) {
    if (signal == SIGXCPU) {
        return "was ended after " + std::to_string(whole_seconds(limits)) + " s";
    }
    if (signal == SIGKILL) {
        return "was killed; the machine may be out of memory";
    }
    return "crashed (signal " + std::to_string(signal) + ")";
}

std::string explain_out_of_memory(const StepLimits& limits) {
    return "needs more than " + std::to_string(limits.memory_mib) + " MiB of memory";
}

template <int Corners>
Pieces<Corners> run_isolated(const std::string& name,
                             const StepLimits& limits,
                             const std::function<Pieces<Corners>()>& step) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
        throw Error(name + " cannot be started: no pipe");
    }
    const pid_t parent = ::getpid();
    const pid_t id = ::fork();
    if (id < 0) {  // GCOVR_EXCL_START: a machine that can have no more processes
        ::close(ends[0]);
        ::close(ends[1]);
        throw Error(name + " cannot be started: no process");
    }  // GCOVR_EXCL_STOP
    if (id == 0) {
        prepare_child(limits, parent);
        answer<Corners>(::fdopen(ends[1], "wb"), name, step);
        ::_exit(0);  // nothing of the parent's is flushed or destroyed twice
    }
    Child child(id);
    ::close(ends[1]);
    const File pipe(::fdopen(ends[0], "rb"));  // closed before the child is waited for
    Pieces<Corners> pieces;
    if (!read_answer(pipe.get(), name, limits, pieces)) {
        const int status = child.wait();
        throw Error(
            name + " "
            + (WIFSIGNALED(status) ? explain_signal(WTERMSIG(status), limits) : "gave no result"));
    }
    return pieces;
}

template Pieces<3> run_isolated(const std::string&,
                                const StepLimits&,
                                const std::function<Pieces<3>()>&);
template Pieces<4> run_isolated(const std::string&,
                                const StepLimits&,
                                const std::function<Pieces<4>()>&);

}  // namespace pent::mesher
