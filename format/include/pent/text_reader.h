#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace pent {

/// A text file, handed out by lines and words; every error names the file and the line.
///
/// Words are split at spaces and tabs. A word that is a backslash alone, at the end of a line,
/// joins it with the next one. A byte-order mark in front of the first line is no part of it.
/// Between lines there may be binary data; behind that, errors name the byte.
class TextReader {
public:
    /// Reads the whole file, or standard input. Throws an Error if that fails.
    /// @param comment  The rest of a line from this character on is skipped; '\0' for no comments.
    explicit TextReader(const std::filesystem::path& path, char comment = '#');

    /// Goes to the next line that has a word; false at the end of the file.
    [[nodiscard]] bool next_line();

    /// The next word of this line; empty at its end.
    [[nodiscard]] std::string_view word();

    /// The next word of this line or of the lines below; throws at the end of the file.
    [[nodiscard]] std::string_view next_word(std::string_view expected);

    /// A word as a finite number; throws an Error that says what was expected.
    [[nodiscard]] double number(std::string_view word, std::string_view expected) const;

    /// A word as a whole number; throws an Error that says what was expected.
    [[nodiscard]] std::int64_t integer(std::string_view word, std::string_view expected) const;

    /// The next three words of this line as a point.
    [[nodiscard]] Eigen::Vector3d point();

    /// A word as an index below `end`; throws an Error that gives both.
    [[nodiscard]] std::uint32_t index(std::string_view word, std::int64_t end) const;

    /// A word as a number of things in the file, each of a byte or more: at most its size.
    [[nodiscard]] std::int64_t count(std::string_view word, std::string_view expected) const;
    [[nodiscard]] std::int64_t count(std::int64_t value, std::string_view expected) const;

    [[nodiscard]] std::uint32_t index(std::int64_t value, std::int64_t end) const;

    /// Leaves out what is left of this line.
    void skip_line() { at_ = end_; }

    /// Whether what is left of this line starts with a text.
    [[nodiscard]] bool starts_with(std::string_view text) const;

    /// What follows the current line.
    [[nodiscard]] std::string_view rest() const;

    /// Takes the next bytes behind the current line, which is over then.
    /// Throws an Error if there are fewer.
    [[nodiscard]] std::string_view take_bytes(std::size_t count, std::string_view expected);

    /// Throws an Error "file: line n: message", or "file: byte n: message" within bytes.
    [[noreturn]] void fail(const std::string& message) const;

    /// Bytes in the file: an upper bound for every count in it.
    [[nodiscard]] std::int64_t size() const { return static_cast<std::int64_t>(text_.size()); }

    [[nodiscard]] const std::string& name() const { return name_; }

private:
    void take_line();
    void skip_space();

    std::string name_;
    std::string text_;
    char comment_;
    std::size_t next_ = 0;  // first character behind the current line
    std::size_t at_ = 0;    // first character of what is left of the current line
    std::size_t end_ = 0;   // behind the current line's last one
    std::int64_t line_number_ = 0;
    bool is_in_bytes_ = false;
};

}  // namespace pent
