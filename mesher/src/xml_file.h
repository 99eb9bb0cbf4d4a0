#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pent::mesher {

/// An element of an XML file, with the text directly in it.
struct XmlElement {
    std::string name;
    std::vector<std::pair<std::string, std::string>> attributes;
    std::string text;
    std::vector<XmlElement> children;
    std::int64_t line = 0;

    /// The value of an attribute; empty if there is none.
    [[nodiscard]] std::string_view attribute(std::string_view key) const;

    /// The first child of that name; null if there is none.
    [[nodiscard]] const XmlElement* child(std::string_view key) const;
};

/// A file of VTK's XML formats.
struct XmlFile {
    XmlElement root;
    std::string_view appended;  ///< What follows the '_' in the element AppendedData.
};

/// A text from a file as it may stand in an error: of one line, with quotes, cut if it is long.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// Parses XML up to the end, or to VTK's element AppendedData, behind which there need be no XML.
///
/// @param text  Lives as long as `appended` is used.
/// @param name  Of the file, for messages.
/// Throws an Error that names file and line for what is no XML, is nested more than 32 deep
/// or has a document type definition.
[[nodiscard]] XmlFile parse_xml(std::string_view text, const std::string& name);

}  // namespace pent::mesher
