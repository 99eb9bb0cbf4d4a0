#include <pent/error.h>
#include <pent/input_path.h>
#include <pent/real_text.h>
#include <pent/text_reader.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iostream>
#include <iterator>
#include <system_error>

namespace pent {

namespace {

// What some editors put in front of a text in UTF-8.
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

// A long word of a binary file would fill the terminal.
std::string quoted(std::string_view word) {
    constexpr std::size_t kLongest = 40;
    std::string text = "\"";
    for (const char c : word.substr(0, kLongest)) {
        text += c >= ' ' && c <= '~' ? c : '?';
    }
    return text + (word.size() > kLongest ? "...\"" : "\"");
}

}  // namespace

TextReader::TextReader(const std::filesystem::path& path, char comment)
    : name_(input_name(path)), comment_(comment) {
    const bool is_standard_input = path.string() == kStandardInput;
    std::ifstream file;
    if (!is_standard_input) {
        refuse_folder(path);
        file.open(path, std::ios::binary);
        if (!file) {
            throw Error(name_ + ": cannot be opened: " + std::generic_category().message(errno));
        }
    }
    std::istream& input = is_standard_input ? std::cin : file;
    try {
        text_.assign(std::istreambuf_iterator<char>(input), std::istreambuf_iterator<char>());
    } catch (const std::ios_base::failure&) {
        throw Error(name_ + ": cannot be read: " + std::generic_category().message(errno));
    }
}

void TextReader::take_line() {
    const std::size_t end = std::min(text_.find('\n', next_), text_.size());
    const std::string_view line = std::string_view(text_).substr(next_, end - next_);
    at_ = next_ + (next_ == 0 && line.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0);
    end_ = next_ + (comment_ == '\0' ? line.size() : std::min(line.find(comment_), line.size()));
    next_ = end + 1;
    ++line_number_;
    is_in_bytes_ = false;
    skip_space();
}

void TextReader::skip_space() {
    while (at_ < end_ && is_space(text_[at_])) {
        ++at_;
    }
}

bool TextReader::next_line() {
    while (next_ < text_.size()) {
        take_line();
        if (at_ < end_) {
            return true;
        }
    }
    at_ = end_;
    return false;
}

std::string_view TextReader::word() {
    for (;;) {
        skip_space();
        const std::size_t start = at_;
        while (at_ < end_ && !is_space(text_[at_])) {
            ++at_;
        }
        const std::string_view found = std::string_view(text_).substr(start, at_ - start);
        if (found != "\\") {
            return found;
        }
        skip_space();
        if (at_ < end_) {
            return found;
        }
        if (!next_line()) {
            return {};
        }
    }
}

std::string_view TextReader::next_word(std::string_view expected) {
    std::string_view found = word();
    while (found.empty()) {
        if (!next_line()) {
            fail("the file ends here; expected " + std::string(expected));
        }
        found = word();
    }
    return found;
}

double TextReader::number(std::string_view word, std::string_view expected) const {
    double value = 0;
    const std::string_view digits = !word.empty() && word.front() == '+' ? word.substr(1) : word;
    const auto [end, error] = real_from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc::result_out_of_range || end != digits.data() + digits.size()
        || digits.empty() || !std::isfinite(value)) {
        fail("found " + quoted(word) + ", expected " + std::string(expected) + ", a finite number");
    }
    return value;
}

std::int64_t TextReader::integer(std::string_view word, std::string_view expected) const {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) {
        fail("found " + quoted(word) + ", expected " + std::string(expected) + ", a whole number");
    }
    return value;
}

Eigen::Vector3d TextReader::point() {
    Eigen::Vector3d point;
    for (double& coordinate : point) {
        coordinate = number(word(), "a coordinate");
    }
    return point;
}

std::uint32_t TextReader::index(std::string_view word, std::int64_t end) const {
    return index(integer(word, "an index"), end);
}

std::uint32_t TextReader::index(std::int64_t value, std::int64_t end) const {
    if (value < 0 || value >= end) {
        fail("index " + std::to_string(value) + " of " + std::to_string(end));
    }
    return static_cast<std::uint32_t>(value);
}

std::int64_t TextReader::count(std::string_view word, std::string_view expected) const {
    return count(integer(word, expected), expected);
}

std::int64_t TextReader::count(std::int64_t value, std::string_view expected) const {
    if (value < 0 || value > size()) {
        fail(std::to_string(value) + " as " + std::string(expected) + " in a file of "
             + std::to_string(size()) + " bytes");
    }
    return value;
}

bool TextReader::starts_with(std::string_view text) const {
    return std::string_view(text_).substr(at_, end_ - at_).starts_with(text);
}

std::string_view TextReader::rest() const {
    return std::string_view(text_).substr(std::min(next_, text_.size()));
}

std::string_view TextReader::take_bytes(std::size_t count, std::string_view expected) {
    const std::string_view behind = rest();
    is_in_bytes_ = true;
    at_ = end_;
    if (behind.size() < count) {
        fail("the file ends here; expected " + std::string(expected));
    }
    const std::string_view taken = behind.substr(0, count);
    line_number_ += std::count(taken.begin(), taken.end(), '\n');
    next_ += count;
    return taken;
}

void TextReader::fail(const std::string& message) const {
    throw Error(
        name_ + ": "
        + (is_in_bytes_ ? "byte " + std::to_string(next_) : "line " + std::to_string(line_number_))
        + ": " + message);
}

}  // namespace pent
