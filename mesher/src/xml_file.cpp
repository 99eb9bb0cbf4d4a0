#include "xml_file.h"

#include <pent/error.h>
#include <pent/printable.h>

#include <algorithm>
#include <expat.h>
#include <limits>
#include <memory>
#include <type_traits>

namespace pent::mesher {

namespace {

constexpr std::size_t kMaxDepth = 32;

// What the parser calls back with.
class Builder {
public:
    explicit Builder(XML_Parser parser) : parser_(parser) {}

    void start(const XML_Char* name, const XML_Char** attributes) {
        if (open_.size() == kMaxDepth) {
            return stop("elements more than " + std::to_string(kMaxDepth) + " deep");
        }
        XmlElement element;
        element.name = name;
        element.line = static_cast<std::int64_t>(XML_GetCurrentLineNumber(parser_));
        for (const XML_Char** at = attributes; *at != nullptr; at += 2) {
            element.attributes.emplace_back(at[0], at[1]);
        }
        const bool is_appended = element.name == "AppendedData";
        open_.push_back(std::move(element));
        if (is_appended) {
            appended_at = XML_GetCurrentByteIndex(parser_);
            XML_StopParser(parser_, XML_FALSE);
        }
    }

    void end() {
        XmlElement element = std::move(open_.back());
        open_.pop_back();
        (open_.empty() ? root : open_.back()).children.push_back(std::move(element));
    }

    void add_text(const XML_Char* text, int length) {
        open_.back().text.append(text, static_cast<std::size_t>(length));
    }

    void stop(const std::string& why) {
        reason = why;
        XML_StopParser(parser_, XML_FALSE);
    }

    // Ends what is open where AppendedData began.
    void close_all() {
        while (!open_.empty()) {
            end();
        }
    }

    XmlElement root;  // has the file's element as its only child
    std::string reason;
    std::int64_t appended_at = -1;

private:
    XML_Parser parser_;
    std::vector<XmlElement> open_;
};

Builder& builder_of(void* data) {
    return *static_cast<Builder*>(data);
}

// What follows the first '_' behind the start of AppendedData.
std::string_view appended_block(std::string_view text, std::int64_t at, const std::string& name) {
    const std::size_t tag_end = text.find('>', static_cast<std::size_t>(at));
    const std::size_t bar = tag_end == std::string_view::npos ? tag_end : text.find('_', tag_end);
    if (bar == std::string_view::npos) {
        throw Error(name + ": AppendedData without the '_' in front of its bytes: the file is cut");
    }
    return text.substr(bar + 1);
}

}  // namespace

std::string_view XmlElement::attribute(std::string_view key) const {
    for (const auto& [known, value] : attributes) {
        if (known == key) {
            return value;
        }
    }
    return {};
}

const XmlElement* XmlElement::child(std::string_view key) const {
    const auto found = std::find_if(children.begin(), children.end(),
                                    [&](const XmlElement& element) { return element.name == key; });
    return found == children.end() ? nullptr : &*found;
}

std::string in_quotes(std::string_view text) {
    constexpr std::size_t kLongest = 60;
    std::string line = printable(text.substr(0, kLongest));
    std::replace(line.begin(), line.end(), '\n', ' ');
    return '"' + line + (text.size() > kLongest ? "...\"" : "\"");
}

XmlFile parse_xml(std::string_view text, const std::string& name) {
    const std::unique_ptr<std::remove_pointer_t<XML_Parser>, decltype(&XML_ParserFree)> parser(
        XML_ParserCreate(nullptr), XML_ParserFree);
    Builder builder(parser.get());
    XML_SetUserData(parser.get(), &builder);
    XML_SetElementHandler(
        parser.get(),
        [](void* data, const XML_Char* element, const XML_Char** attributes) {
            builder_of(data).start(element, attributes);
        },
        [](void* data, const XML_Char*) { builder_of(data).end(); });
    XML_SetCharacterDataHandler(parser.get(), [](void* data, const XML_Char* piece, int length) {
        builder_of(data).add_text(piece, length);
    });
    XML_SetStartDoctypeDeclHandler(
        parser.get(), [](void* data, const XML_Char*, const XML_Char*, const XML_Char*, int) {
            builder_of(data).stop("a document type definition; expected none");
        });
    constexpr std::size_t kPiece = std::size_t{1} << 30;  // lengths are int
    XML_Status status = XML_STATUS_OK;
    for (std::size_t at = 0; status == XML_STATUS_OK && (at < text.size() || at == 0);) {
        const std::size_t size = std::min(kPiece, text.size() - at);
        status = XML_Parse(parser.get(), text.data() + at, static_cast<int>(size),
                           at + size == text.size() ? 1 : 0);
        at += std::max<std::size_t>(size, 1);
    }
    XmlFile file;
    if (builder.appended_at >= 0) {
        builder.close_all();
        file.appended = appended_block(text, builder.appended_at, name);
    } else if (status != XML_STATUS_OK) {
        const std::string why = !builder.reason.empty()
                                    ? builder.reason
                                    : XML_ErrorString(XML_GetErrorCode(parser.get()));
        throw Error(name + ": line " + std::to_string(XML_GetCurrentLineNumber(parser.get()))
                    + ": no XML that can be read: " + why + "; is the file cut?");
    }
    file.root = std::move(builder.root.children.front());
    return file;
}

}  // namespace pent::mesher
