#pragma once

#include "xml_file.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pent::mesher {

/// How the arrays of one of VTK's XML files are encoded.
struct VtkEncoding {
    std::string name;           ///< Of the file, for messages.
    std::size_t file_size = 0;  ///< No array has more bytes than this bears out.
    bool is_big_endian = false;
    bool has_long_headers = false;  ///< Numbers of bytes are UInt64, else UInt32.
    bool is_compressed = false;     ///< By zlib.
    bool is_appended_raw = true;    ///< Else base64.
    std::string_view appended;
};

/// What the attributes of the element VTKFile say. Throws an Error for what is not supported.
[[nodiscard]] VtkEncoding encoding_of(const XmlFile& file,
                                      const std::string& name,
                                      std::size_t file_size);

/// Whether an array holds numbers, and no text.
[[nodiscard]] bool has_numbers(const XmlElement& array);

/// How many numbers a tuple has; 1 if the array does not say so.
[[nodiscard]] std::int64_t components_of(const XmlElement& array, const VtkEncoding& encoding);

/// The numbers of a DataArray: in ascii, in base64 or appended, compressed or not.
/// Throws an Error that names file, line and array for what is damaged or cut, and unless there are
/// `count` of them.
[[nodiscard]] std::vector<double> reals_of(const XmlElement& array,
                                           const VtkEncoding& encoding,
                                           std::int64_t count);
[[nodiscard]] std::vector<std::int64_t> integers_of(const XmlElement& array,
                                                    const VtkEncoding& encoding,
                                                    std::int64_t count);

/// "FILE: line N: array NAME: ", in front of what is wrong with an array.
[[nodiscard]] std::string place_of(const XmlElement& array, const VtkEncoding& encoding);

}  // namespace pent::mesher
