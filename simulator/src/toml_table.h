#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pent::simulator {

/// Thrown where the parser of toml++ meets what it takes for impossible.
struct BrokenToml {};
[[noreturn]] inline void refuse_broken_toml() {
    throw BrokenToml{};
}

}  // namespace pent::simulator

// Some damaged files break assertions of toml++, and without asserts it lets the compiler assume
// them: undefined behavior from a file. Kept on in every build, they refuse the file.
#pragma push_macro("NDEBUG")
#undef NDEBUG
#define TOML_ASSERT(expr) ((expr) ? void() : pent::simulator::refuse_broken_toml())
#define TOML_HEADER_ONLY 1
#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

namespace pent::simulator {

/// Which numbers a key takes; the text completes "expected a number ...".
struct Range {
    double low = -std::numeric_limits<double>::infinity();
    bool low_included = true;
    double high = std::numeric_limits<double>::infinity();
    bool high_included = true;
};

inline constexpr Range kAnyNumber{};
inline constexpr Range kPositive{.low = 0, .low_included = false};
inline constexpr Range kNotNegative{.low = 0};

/// One table of a TOML file, read strictly: every function knows a key, checks its value, and throws
/// an Error with file:line:column; finish() refuses the keys that no function asked for.
class TableReader {
public:
    /// @param name  How messages call the table, as in "[solver]".
    TableReader(const toml::table& table, std::string name, std::string file);

    [[nodiscard]] bool has(std::string_view key);

    /// A missing key gives `fallback`, or is an error if there is none.
    [[nodiscard]] double number(std::string_view key,
                                std::optional<double> fallback,
                                const Range& range);
    [[nodiscard]] std::int64_t integer(std::string_view key,
                                       std::optional<std::int64_t> fallback,
                                       std::int64_t low,
                                       std::int64_t high);
    [[nodiscard]] bool flag(std::string_view key, bool fallback);
    [[nodiscard]] std::string text(std::string_view key);
    [[nodiscard]] Eigen::VectorXd vector(std::string_view key,
                                         int length,
                                         const std::optional<Eigen::VectorXd>& fallback);

    /// One of a list of names, which the error message lists; gives its place in the list.
    [[nodiscard]] std::size_t choice(std::string_view key,
                                     const std::vector<std::string_view>& names,
                                     std::size_t fallback);

    /// A table within the table; has(key) must hold.
    [[nodiscard]] TableReader table(std::string_view key);

    /// All tables of an array; none if the key is missing. A single table counts as an array of one.
    [[nodiscard]] std::vector<TableReader> tables(std::string_view key);

    /// The one of these keys that is there; an Error unless it is exactly one. Ask for all other
    /// keys before.
    [[nodiscard]] std::string one_of(const std::vector<std::string>& kinds);

    /// Whether the value is a plain string.
    [[nodiscard]] bool is_text(std::string_view key);

    /// Refuses a key with a reason, if it is there.
    void refuse(std::string_view key, std::string_view reason);

    /// Throws an Error for the first key that nobody asked for, with the nearest known one.
    void finish() const;

    /// Throws an Error at the value of `key`, or at the table if there is none.
    [[noreturn]] void fail(std::string_view key, const std::string& message) const;

    [[nodiscard]] const std::string& name() const { return name_; }

private:
    const toml::node* find(std::string_view key);
    [[noreturn]] void fail_missing(std::string_view key, std::string_view type) const;

    const toml::table* table_;
    std::string name_;
    std::string file_;
    std::vector<std::string> known_;
};

/// Parses a whole file. Throws an Error with file:line:column.
[[nodiscard]] toml::table parse_toml(std::string_view text, const std::string& file);

/// "; did you mean "young"?" for the candidate nearest to `word`, or nothing if none is near.
[[nodiscard]] std::string did_you_mean(std::string_view word,
                                       const std::vector<std::string>& candidates);

}  // namespace pent::simulator
