#pragma once

#include <pent/simulator/ranks.h>

#include <memory>
#include <string>

namespace pent::distributed {

/// MPI and PETSc, from the beginning of a program to its end. One in a process.
class MpiSession {
public:
    /// Starts both; PETSc reads no files and catches no signals. Throws an Error if it cannot.
    MpiSession();

    /// Ends both, if finish() has not.
    ~MpiSession();
    MpiSession(const MpiSession&) = delete;
    MpiSession& operator=(const MpiSession&) = delete;
    MpiSession(MpiSession&&) = delete;
    MpiSession& operator=(MpiSession&&) = delete;

    [[nodiscard]] std::shared_ptr<const simulator::Ranks> ranks() const { return ranks_; }

    /// Waits until all ranks have come here, which they do together unless something went wrong on
    /// some alone (memory that ran out): the others then wait for it forever. After a few seconds
    /// that ends them all, with the exit code and one line on stderr.
    ///
    /// @param code   Exit code of this rank.
    /// @param error  What went wrong here; empty if nothing did.
    void finish(int code, const std::string& error);

private:
    std::shared_ptr<const simulator::Ranks> ranks_;
};

}  // namespace pent::distributed
