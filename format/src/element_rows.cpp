#include "element_rows.h"

#include "input_file.h"

namespace pent {

Header read_header(const std::filesystem::path& path) {
    constexpr std::size_t kLongestHeader = std::size_t{1} << 20;
    return parse_header(read_input(path, kLongestHeader).view(), path);
}

std::size_t row_bytes(const PlyElement& element) {
    std::size_t bytes = 0;
    for (const PlyProperty& property : element.properties) {
        bytes += size_of(property.type);
    }
    return bytes;
}

void read_rows(const std::filesystem::path& path,
               Encoding encoding,
               const RowBytes& bytes,
               const PlyElement& rows,
               const std::vector<Column>& columns) {
    const InputFile file = read_input(path, bytes.last - bytes.first, bytes.first);
    Header header;
    header.info.encoding = encoding;
    header.elements = {rows};
    BodyReader(header, file.view(), path).read(columns, bytes.in_front);
}

}  // namespace pent
