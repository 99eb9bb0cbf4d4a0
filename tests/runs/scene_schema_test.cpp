#include <pent/error.h>
#include <pent/read_text.h>
#include <pent/runs/report.h>
#include <pent/runs/scene_file.h>

#include <gtest/gtest.h>

#include <map>
#include <sstream>

// What follows from a schema that has every key once.

namespace pent::runs {
namespace {

using Tables = std::map<std::string, std::string>;

// The first table behind each line that begins with the name of a block, bold: **[block]** of
// scenes, **`steps`** of reports.
Tables tables_of(const std::string& text) {
    Tables tables;
    std::istringstream lines(text);
    std::string line;
    std::string block;
    bool is_within = false;
    while (std::getline(lines, line)) {
        if (line.starts_with("**[") || line.starts_with("**`") || line.starts_with("**Each of `")) {
            block = line.substr(2, line.find("**", 2) - 2);
        }
        const bool is_row = !line.empty() && line[0] == '|';
        if (is_row && !block.empty()) {
            tables[block] += line + "\n";
        } else if (is_within) {
            block.clear();
        }
        is_within = is_row;
    }
    return tables;
}

TEST(SchemaText, IsWhatTheDocsHave) {
    const Tables docs = tables_of(read_text(PENT_DOCS "/simulator.md", "the docs"));
    const Tables schema = tables_of(schema_text() + report_schema_text());
    EXPECT_EQ(schema.size(), 21U);
    for (const auto& [block, table] : schema) {
        const auto found = docs.find(block);
        ASSERT_NE(found, docs.end()) << block;
        EXPECT_EQ(found->second, table) << block << ": put in what pent-sim --schema prints";
    }
}

std::string error_of(const std::string& block) {
    try {
        static_cast<void>(
            parse_scene("[[body]]\nname = \"a\"\nmesh = \"a.pent\"\n" + block, "s.toml", ""));
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

TEST(ParseSceneErrors, NameTheBlockThatAKeyBelongsTo) {
    EXPECT_EQ(error_of("[solver]\nfriction = 1\n"),
              "s.toml:5:1: unknown key \"friction\" in \"solver\"; \"friction\" belongs to"
              " [[body]] or [[obstacle]] or [contact]");
    EXPECT_EQ(error_of("young = 1\n"),
              "s.toml:4:1: unknown key \"young\" in \"body\"; \"young\" belongs to \"material\" of"
              " [[body]] or \"region.material\" of [[body]]");
    EXPECT_EQ(error_of("[output]\nstiffness = 1\n"),
              "s.toml:5:1: unknown key \"stiffness\" in \"output\"; \"stiffness\" belongs to"
              " [[attachment]] or [[obstacle]] or [contact] or [damping]");
    EXPECT_EQ(error_of("[solver]\nup = 1\n"),
              "s.toml:5:1: unknown key \"up\" in \"solver\"; \"up\" belongs to \"bowl\" of"
              " [[obstacle]]");
    EXPECT_EQ(error_of("[[constraint]]\nbody = \"a\"\nlow = 1\n"),
              "s.toml:6:1: unknown key \"low\" in \"constraint\"; \"low\" belongs to"
              " \"region.select.box\" of [[body]] or \"select.box\" of [[constraint]] or"
              " \"select.box\" of [[load]] or \"select.box\" of [[activation]] or"
              " \"away_from.box\" of [[activation]] or \"select.box\" of [[attachment]]");
}

TEST(ParseSceneErrors, NameTheBlockOfAKeyThatIsATable) {
    const std::string selections =
        "\"region.select\" of [[body]] or \"select\" of [[constraint]] or \"select\" of [[load]]"
        " or \"select\" of [[activation]] or \"away_from\" of [[activation]] or \"select\" of"
        " [[attachment]]";
    EXPECT_EQ(
        error_of("[contact]\nlayers = { first = 0 }\n"),
        "s.toml:5:1: unknown key \"layers\" in \"contact\"; \"layers\" belongs to " + selections);
    for (const std::string kind : {"ball", "box", "half_space"}) {
        EXPECT_EQ(error_of("[solver]\n" + kind + " = 1\n"),
                  "s.toml:5:1: unknown key \"" + kind + "\" in \"solver\"; \"" + kind
                      + "\" belongs to " + selections + " or [[obstacle]]");
    }
    EXPECT_EQ(error_of("[[constraint]]\nbody = \"a\"\nplace = {}\n"),
              "s.toml:6:1: unknown key \"place\" in \"constraint\"; \"place\" belongs to"
              " [[body]]");
    EXPECT_EQ(error_of("[solver]\nsleep = true\n"),
              "s.toml:5:1: unknown key \"sleep\" in \"solver\"; \"sleep\" is a block of its own,"
              " [sleep]");
}

TEST(ParseSceneErrors, NameTheBlockOfAKeyOfOldFiles) {
    EXPECT_EQ(error_of("[solver]\ncontact_forces = true\n"),
              "s.toml:5:1: unknown key \"contact_forces\" in \"solver\"; \"contact_forces\" belongs"
              " to [output]");
}

// Each key of the tables, in a block that has none of them but two.
TEST(ParseSceneErrors, NameABlockForEveryKeyThatTheSchemaHas) {
    std::istringstream lines(schema_text());
    std::string line;
    int count = 0;
    while (std::getline(lines, line)) {
        if (!line.starts_with("| `")) {
            continue;
        }
        std::istringstream keys(line.substr(3, line.find_first_of("` ", 3) - 3));
        std::string key;
        while (std::getline(keys, key, '.')) {
            if (key != "speed" && key != "time") {
                const std::string error = error_of("[sleep]\n" + key + " = 1\n");
                EXPECT_NE(error.find("; \"" + key + "\" belongs to "), std::string::npos) << error;
                ++count;
            }
        }
    }
    EXPECT_GT(count, 80);
}

TEST(ParseSceneErrors, ListTheKeysOfABlockWhereNoneIsNear) {
    EXPECT_EQ(error_of("[sleep]\nqqqqqqqqqq = 1\n"),
              "s.toml:5:1: unknown key \"qqqqqqqqqq\" in \"sleep\"; expected one of speed, time");
    EXPECT_EQ(
        error_of("[qqqqqqqqqq]\nspeed = 1\n"),
        "s.toml:4:2: unknown key \"qqqqqqqqqq\" in the scene; expected one of scene, body,"
        " constraint, load, activation, attachment, obstacle, contact, damping, sleep, solver,"
        " output");
    EXPECT_EQ(error_of("[[constraint]]\nbody = \"a\"\nselect = { region = 1, qqqqqqqqqq = 1 }\n"),
              "s.toml:6:24: unknown key \"qqqqqqqqqq\" in \"select\"; expected \"region\" alone");
}

// Members of the schema that no key has.
TEST(ParseSceneErrors, RefuseWhatIsNoKeyInAFile) {
    EXPECT_NE(error_of("material = { lame = 1 }\n").find("unknown key \"lame\""),
              std::string::npos);
    EXPECT_NE(error_of("[[obstacle]]\nshape = 1\n").find("unknown key \"shape\""),
              std::string::npos);
}

}  // namespace
}  // namespace pent::runs
