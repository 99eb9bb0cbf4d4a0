#include "body.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace pent {
namespace {

constexpr std::uint64_t kRows = 3;

// Least, greatest and zero of a type, row after row, each behind a byte that belongs to nobody.
template <typename Value>
std::string extremes() {
    using Limits = std::numeric_limits<Value>;
    std::string rows;
    for (const Value value : {Limits::lowest(), Limits::max(), Value{}}) {
        rows += '?';
        rows.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    return rows;
}

void expect_round_trip(PlyType type, std::string rows) {
    const std::size_t stride = rows.size() / kRows;
    ASSERT_EQ(stride, 1 + size_of(type));
    std::string back(rows.size(), '?');
    for (const Encoding encoding : {Encoding::Binary, Encoding::Ascii}) {
        const std::vector<Column> columns = {{"a", type, rows.data() + 1, stride}};
        std::string body;
        encode_rows(body, encoding, columns, kRows);
        Header header;
        header.info.encoding = encoding;
        header.elements = {make_element("any", kRows, columns)};
        BodyReader reader(header, body, "any.pent");
        reader.read({{"a", type, back.data() + 1, stride}});
        reader.finish();
        EXPECT_EQ(back, rows) << name_of(type);
    }
}

TEST(Body, KeepsTheExtremesOfEveryType) {
    expect_round_trip(PlyType::Char, extremes<std::int8_t>());
    expect_round_trip(PlyType::Uchar, extremes<std::uint8_t>());
    expect_round_trip(PlyType::Short, extremes<std::int16_t>());
    expect_round_trip(PlyType::Ushort, extremes<std::uint16_t>());
    expect_round_trip(PlyType::Int, extremes<std::int32_t>());
    expect_round_trip(PlyType::Uint, extremes<std::uint32_t>());
    expect_round_trip(PlyType::Float, extremes<float>());
    expect_round_trip(PlyType::Double, extremes<double>());
}

}  // namespace
}  // namespace pent
