#include "usage_error.h"

#include <pent/nearest_name.h>

#include <algorithm>
#include <optional>
#include <sstream>
#include <vector>

namespace pent::apps {

namespace {

// Those of a program, groups of which one is needed included.
std::vector<const CLI::Option*> options_of(const CLI::App& cli) {
    std::vector<const CLI::Option*> options = cli.get_options();
    for (const CLI::App* group : cli.get_subcommands([](const CLI::App*) { return true; })) {
        const std::vector<const CLI::Option*> more = options_of(*group);
        options.insert(options.end(), more.begin(), more.end());
    }
    return options;
}

const CLI::Option* option_called(const CLI::App& cli, const std::string& name) {
    const std::vector<const CLI::Option*> options = options_of(cli);
    const auto found = std::ranges::find_if(options, [&](const CLI::Option* option) {
        return option->check_name(name) || option->get_name() == name;
    });
    return found == options.end() ? nullptr : *found;
}

// The option whose name is in front of a part of a message: "--w" of "--w: 1 required C missing".
const CLI::Option* option_before(const CLI::App& cli,
                                 const std::string& text,
                                 const std::string& part) {
    const std::size_t end = text.find(part);
    return end == std::string::npos ? nullptr : option_called(cli, text.substr(0, end));
}

std::string replaced(std::string text, const std::string& old, const std::string& by) {
    if (const std::size_t at = text.find(old); at != std::string::npos) {
        text.replace(at, old.size(), by);
    }
    return text;
}

// What belongs behind an option: "a whole number from 1 to 64", "auto|light|wrap|none", "FILE".
std::string kind_of_value(const CLI::Option& option) {
    if (const std::string told = option.get_option_text(); !told.empty()) {
        return told.substr(0, told.find(" ["));
    }
    std::string kind = option.get_type_name();  // "INT:from 1 to 64"
    std::replace(kind.begin(), kind.end(), ':', ' ');
    for (const char* whole : {"UINT", "INT"}) {
        kind = kind.starts_with(whole) ? replaced(kind, whole, "a whole number") : kind;
    }
    kind = kind.starts_with("FLOAT") ? replaced(kind, "FLOAT", "a number") : kind;
    return kind.starts_with("TEXT") ? replaced(kind, "TEXT", "a word") : kind;
}

// The same with what --help says of the option, but for what it is without one:
// "C (Slice at w = C, m; several with commas)".
std::string wanted_value(const CLI::Option& option) {
    const std::string said = option.get_description();
    const std::size_t preset = std::min(said.find("; default:"), said.find(", default:"));
    return kind_of_value(option) + " (" + said.substr(0, preset) + ")";
}

// What an option wants whose value is no number: "--layers: found "many"; expected a whole number",
// or "" if another option is meant.
std::string misread_value(const CLI::App& cli, const std::string& text) {
    for (const CLI::Option* option : options_of(cli)) {
        const std::string before =
            option->get_name() + " = ";  // "Could not convert: --layers = many"
        const std::size_t at = text.find(before);
        if (at == std::string::npos) {
            continue;
        }
        const std::string type = option->get_type_name();
        const auto is_of = [&](const char* name) { return type.find(name) != std::string::npos; };
        return option->get_name() + ": found \"" + text.substr(at + before.size()) + "\"; expected "
               + (is_of("UINT") || is_of("INT") ? "a whole number"
                  : is_of("FLOAT")              ? "a number"
                  : type.empty()                ? "nothing after it"
                                                : type);
    }
    return "";
}

// "unknown option --layer; did you mean --layers?", or "" if every option is known.
std::string unknown_option(const CLI::App& cli) {
    for (const std::string& word : cli.remaining()) {
        if (word.size() < 2 || word[0] != '-') {
            continue;
        }
        const std::string unknown = word.substr(0, word.find('='));
        std::vector<std::string> known;
        for (const CLI::Option* option : options_of(cli)) {
            known.push_back(option->get_name());
        }
        const std::string best = nearest_name(unknown, known);
        return "unknown option " + unknown + (best.empty() ? "" : "; did you mean " + best + "?");
    }
    return "";
}

// Too few values, or too many.
std::string wrong_count(const CLI::App& cli, const std::string& text) {
    if (const CLI::Option* none = option_before(cli, text, ": 1 required"); none != nullptr) {
        return none->get_name() + ": found no value; expected " + wanted_value(*none);
    }
    for (const char* bound : {": At least ", ": At Most "}) {
        if (const CLI::Option* option = option_before(cli, text, bound); option != nullptr) {
            const std::string count = text.substr(text.rfind(' ') + 1);
            return option->get_name() + ": found " + count + (count == "1" ? " value" : " values")
                   + "; expected " + wanted_value(*option);
        }
    }
    return "";
}

// One of several: "[input,--sphere,--ball,--box]" in what CLI11 says.
std::string one_of_several(const std::string& text) {
    const std::size_t begin = text.find('[');
    const std::size_t end = text.rfind(']');
    if (begin == std::string::npos || end == std::string::npos) {
        return "";
    }
    std::istringstream names(text.substr(begin + 1, end - begin - 1));
    std::string list;
    for (std::string name; std::getline(names, name, ',');) {
        list += (list.empty() ? "" : ", ") + name;
    }
    const bool is_none = text.find("were given") == std::string::npos;
    return (is_none ? "found none of " : "found several of ") + list + "; expected one of them";
}

std::string missing_option(const CLI::App& cli, const std::string& text) {
    const CLI::Option* option = option_before(cli, text, " is required");
    return option == nullptr
               ? one_of_several(text)
               : option->get_name() + " is missing; expected " + wanted_value(*option);
}

// Words that belong to no option.
std::string more_than_expected(const CLI::App& cli) {
    const std::vector<std::string> words = cli.remaining();
    return words.empty() ? ""
                         : "found \"" + words.front()
                               + "\" where nothing more belongs; lists have commas and no blanks,"
                                 " as in 1,2,3";
}

}  // namespace

std::string swallowed_option(const CLI::App& cli) {
    for (const CLI::Option* option : options_of(cli)) {
        if (option->get_positional()) {
            continue;  // what follows "--" may have any name
        }
        for (const std::string& value : option->results()) {
            if (value.size() > 1 && value[0] == '-' && option_called(cli, value) != nullptr) {
                return option->get_name() + ": found the option " + value + " after it; expected "
                       + wanted_value(*option);
            }
        }
    }
    return "";
}

std::string usage_error(const CLI::App& cli, const CLI::ParseError& error) {
    const std::string text = error.what();
    std::string said = unknown_option(cli);
    if (said.empty() && dynamic_cast<const CLI::ConversionError*>(&error) != nullptr) {
        said = misread_value(cli, text);
    }
    if (said.empty() && dynamic_cast<const CLI::ValidationError*>(&error) == nullptr) {
        said = swallowed_option(cli);
    }
    if (said.empty() && dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
        said = wrong_count(cli, text);
    }
    if (said.empty() && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
        said = missing_option(cli, text);
    }
    if (said.empty() && dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
        said = more_than_expected(cli);
    }
    if (dynamic_cast<const CLI::RequiresError*>(&error) != nullptr && said.empty()) {
        said = text + "; give both or none";
    }
    if (dynamic_cast<const CLI::ExcludesError*>(&error) != nullptr && said.empty()) {
        said = text + "; give one of them";
    }
    return said.empty() ? text : said;
}

}  // namespace pent::apps
