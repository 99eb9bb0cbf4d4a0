#include "gzip.h"
#include "read_image.h"

#include <pent/counted.h>
#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/real_text.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

namespace pent::mesher {

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// What a header says, as far as it matters here.
struct NrrdHeader {
    std::string type;
    std::string encoding;
    std::string endian;
    int dimension = 0;
    std::vector<double> sizes;
    std::vector<double> spacings;
    std::size_t samples_at = 0;  // first byte behind the header
};

std::vector<std::string> words_of(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) {
        words.push_back(word);
    }
    return words;
}

double number_of(const std::string& word) {
    double value = kUnknown;
    const char* end = word.data() + word.size();
    const std::from_chars_result result = real_from_chars(word.data(), end, value);
    return result.ec == std::errc() && result.ptr == end ? value : kUnknown;
}

std::vector<double> numbers_of(const std::string& text) {
    std::vector<double> numbers;
    for (const std::string& word : words_of(text)) {
        numbers.push_back(number_of(word));
    }
    return numbers;
}

// Lengths of vectors "(x,y,z)"; of "none" nothing is known.
std::vector<double> lengths_of(const std::string& text) {
    std::vector<double> lengths;
    std::size_t at = 0;
    while ((at = text.find_first_not_of(' ', at)) != std::string::npos) {
        if (text[at] != '(') {
            lengths.push_back(kUnknown);
            at = std::min(text.find(' ', at), text.size());
            continue;
        }
        const std::size_t end = std::min(text.find(')', at), text.size());
        std::string inner = text.substr(at + 1, end - at - 1);
        std::replace(inner.begin(), inner.end(), ',', ' ');
        double square = 0;
        for (const double part : numbers_of(inner)) {
            square += part * part;
        }
        lengths.push_back(std::sqrt(square));
        at = std::min(end + 1, text.size());
    }
    return lengths;
}

[[noreturn]] void fail(const std::string& name, std::size_t line, const std::string& message) {
    throw Error(name + ": line " + std::to_string(line) + ": " + message);
}

void take_field(const std::string& field,
                const std::string& value,
                const std::string& name,
                std::size_t line,
                NrrdHeader& header) {
    if (field == "type") {
        header.type = value;
    } else if (field == "encoding") {
        header.encoding = value;
    } else if (field == "endian") {
        header.endian = value;
    } else if (field == "dimension") {
        const double dimension = number_of(value);
        header.dimension = dimension >= 1 && dimension <= 16 ? static_cast<int>(dimension) : 0;
    } else if (field == "sizes") {
        header.sizes = numbers_of(value);
    } else if (field == "spacings") {
        header.spacings = numbers_of(value);
    } else if (field == "space directions") {
        header.spacings = lengths_of(value);
    } else if (field == "data file" || field == "datafile") {
        fail(name, line, "has its samples in another file; expected them behind the header");
    } else if ((field == "line skip" || field == "lineskip" || field == "byte skip"
                || field == "byteskip")
               && number_of(value) != 0) {
        fail(name, line, "skips lines or bytes; expected the samples right behind the header");
    }
}

NrrdHeader read_header(std::string_view bytes, const std::string& name) {
    if (!bytes.starts_with("NRRD000")) {
        throw Error(name + ": is no NRRD file: it does not begin with NRRD000");
    }
    NrrdHeader header;
    std::size_t at = 0;
    for (std::size_t number = 1; at < bytes.size(); ++number) {
        const std::size_t end = std::min(bytes.find('\n', at), bytes.size());
        std::string line(bytes.substr(at, end - at));
        at = std::min(end + 1, bytes.size());
        if (line.ends_with('\r')) {
            line.pop_back();
        }
        if (line.empty()) {
            header.samples_at = at;
            return header;
        }
        const std::size_t colon = line.find(": ");
        if (number > 1 && line[0] != '#' && colon != std::string::npos) {
            const std::size_t first = line.find_first_not_of(' ', colon + 1);
            take_field(line.substr(0, colon), first == std::string::npos ? "" : line.substr(first),
                       name, number, header);
        }
    }
    throw Error(name + ": ends too soon: no empty line behind its header");
}

std::optional<SampleKind> kind_of(const std::string& type) {
    struct Named {
        SampleKind kind;
        std::vector<std::string_view> names;
    };
    static const std::array<Named, 8> all = {
        {{{'i', 1}, {"signed char", "int8", "int8_t"}},
         {{'u', 1}, {"uchar", "unsigned char", "uint8", "uint8_t"}},
         {{'i', 2}, {"short", "short int", "signed short", "signed short int", "int16", "int16_t"}},
         {{'u', 2}, {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"}},
         {{'i', 4}, {"int", "signed int", "int32", "int32_t"}},
         {{'u', 4}, {"uint", "unsigned int", "uint32", "uint32_t"}},
         {{'f', 4}, {"float"}},
         {{'f', 8}, {"double"}}}};
    for (const Named& named : all) {
        if (std::find(named.names.begin(), named.names.end(), type) != named.names.end()) {
            return named.kind;
        }
    }
    return std::nullopt;
}

void take_text(std::string_view text, Image& image) {
    const auto count = static_cast<std::size_t>(image.size.cast<std::int64_t>().prod());
    std::istringstream stream{std::string(text)};
    for (std::string word; image.values.size() < count && stream >> word;) {
        image.values.push_back(static_cast<float>(number_of(word)));
    }
    if (image.values.size() < count) {
        throw Error(image.name
                    + formatted(": ends too soon: %zu samples, expected %zu; is it cut?",
                                image.values.size(), count));
    }
    check_samples(image);
}

}  // namespace

Image read_nrrd(std::string_view bytes, const std::string& name) {
    const NrrdHeader header = read_header(bytes, name);
    if (header.dimension != 4 || header.sizes.size() != 4) {
        throw Error(name + ": an image of " + counted(header.dimension, "axis", "axes") + ", with "
                    + counted(header.sizes.size(), "size", "sizes")
                    + "; expected 4, as x y z and time");
    }
    Image image;
    image.name = name;
    const Eigen::Vector4d size(header.sizes.data());
    check_size(name, size);
    image.size = size.cast<int>();
    const bool has_spacing = header.spacings.size() == 4;
    image.spacing = has_spacing ? Eigen::Vector4d(header.spacings.data())
                                : Eigen::Vector4d(Eigen::Vector4d::Constant(kUnknown));
    std::optional<SampleKind> kind = kind_of(header.type);
    if (!kind) {
        throw Error(name + ": samples of type \"" + header.type.substr(0, 40)
                    + "\"; expected whole numbers of 8, 16 or 32 bits, float or double");
    }
    const bool is_big = header.endian == "big";
    kind->is_swapped = is_big == (std::endian::native == std::endian::little);
    const std::string_view samples = bytes.substr(header.samples_at);
    if (header.encoding == "raw") {
        take_samples(samples, *kind, 1, 0, image);
    } else if (header.encoding == "gzip" || header.encoding == "gz") {
        const auto count = static_cast<std::size_t>(size.prod());
        take_samples(unpack_gzip(samples, count * kind->bytes, name), *kind, 1, 0, image);
    } else if (header.encoding == "text" || header.encoding == "txt"
               || header.encoding == "ascii") {
        take_text(samples, image);
    } else {
        throw Error(name + ": samples in the encoding \"" + header.encoding.substr(0, 40)
                    + "\"; expected raw, gzip or text");
    }
    return image;
}

}  // namespace pent::mesher
