#include "child.h"
#include "draw.h"
#include "folders.h"
#include "laws.h"
#include "meshes.h"
#include "off_law.h"
#include "shrink.h"
#include "support/temp_folder.h"
#include "written_law.h"

#include <pent/error.h>
#include <pent/runs/scene_file.h>
#include <pent/runs/scene_keys.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <numeric>
#include <set>

namespace pent::scene_fuzz {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kSeeds = 1500;

// The scene as the simulator writes it, every default filled in.
Json written(const Json& scene) {
    return parse_document(runs::scene_text(runs::parse_scene(toml_text(scene), "drawn", "")));
}

// ----------------------------------------------------------------------------------- the generator

TEST(DrawScene, GivesTheSameSceneForASeedAndAnotherForAnother) {
    EXPECT_EQ(toml_text(draw_scene(7)), toml_text(draw_scene(7)));
    EXPECT_NE(toml_text(draw_scene(7)), toml_text(draw_scene(8)));
}

TEST(DrawScene, GivesScenesThatReadBackAndAreAccepted) {
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
        const Json scene = draw_scene(seed);
        ASSERT_NO_THROW(static_cast<void>(written(scene))) << toml_text(scene);
        ASSERT_EQ(toml_text(parse_document(toml_text(scene))).size(), toml_text(scene).size());
    }
}

// A key that the simulator learns has to become a line of draw.cpp.
TEST(DrawScene, DrawsEveryKeyThatAWrittenSceneHas) {
    std::set<std::string> drawn;
    std::set<std::string> known;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
        const Json scene = draw_scene(seed);
        for (const std::string& path : key_paths(scene)) {
            drawn.insert(path);
        }
        for (const std::string& path : key_paths(written(scene))) {
            known.insert(path);
        }
    }
    EXPECT_GT(known.size(), 60U);
    for (const std::string& path : known) {
        EXPECT_TRUE(drawn.contains(path)) << path;
    }
    for (const char* path : {"solver.preset", "body.material.young", "body.material.poisson"}) {
        EXPECT_TRUE(drawn.contains(path)) << path;  // written in other words
    }
}

// What a scene has, as words such as "solver.integrator=bdf2"; of a count or a number whether it is
// there.
std::set<std::string> features(const Json& scene) {
    std::set<std::string> found;
    for (const char* path :
         {"scene.dimension", "solver.integrator", "solver.elements", "solver.filter",
          "solver.linear", "solver.preconditioner", "solver.precision", "contact.model",
          "contact.self", "contact.filter", "output.contact_pairs"}) {
        if (const Json value = value_at(scene, path); !value.is_null()) {
            found.insert(std::string(path) + "=" + value.dump());
        }
    }
    for (const char* path : {"contact.friction", "contact.separation", "damping.mass",
                             "damping.stiffness", "sleep.speed"}) {
        const Json value = value_at(scene, path);
        found.insert(std::string(!value.is_null() && value > 0 ? "with " : "without ") + path);
    }
    const bool has_ties = !scene.value("attachment", Json::array()).empty();
    found.insert(has_ties ? "with attachment" : "without attachment");
    found.insert("bodies=" + std::to_string(scene["body"].size()));
    for (const Json& body : scene["body"]) {
        found.insert("model=" + body["material"]["model"].dump());
        found.insert("mesh=" + parse_mesh_name(body["mesh"]).kind);
    }
    for (const char* block : {"obstacle", "constraint", "load"}) {
        for (const Json& entry : scene.value(block, Json::array())) {
            const Json& select = entry.value("select", Json());
            const Json& kinds = select.is_array() ? select[0] : select.is_null() ? entry : select;
            found.insert(std::string(block) + "="
                         + (kinds.is_object() ? kinds.begin().key() : "everything"));
        }
    }
    return found;
}

// Of pairs that docs/simulator.md refuses, and of those that no scene can have.
bool is_impossible(const std::string& a, const std::string& b) {
    const auto is = [&](const std::string& x, const std::string& y) {
        return (a.starts_with(x) && b.starts_with(y)) || (a.starts_with(y) && b.starts_with(x));
    };
    const std::string key_of_a = a.substr(0, a.find('='));
    const bool is_one_of_two = key_of_a == b.substr(0, b.find('=')) && key_of_a != "model"
                               && key_of_a != "mesh" && key_of_a != "obstacle"
                               && key_of_a != "constraint";
    const bool is_with_and_without =
        a.substr(a.find(' ') + 1) == b.substr(b.find(' ') + 1) && a != b && a.starts_with("with");
    return is_one_of_two || is_with_and_without
           || is("contact.model=\"barrier\"", "solver.integrator=\"linear_euler\"")
           || is("with sleep", "solver.integrator=\"quasistatic\"");
}

TEST(DrawScene, DrawsEveryPairOfFeaturesThatGoTogether) {
    std::set<std::string> all;
    std::set<std::pair<std::string, std::string>> pairs;
    for (std::uint64_t seed = 0; seed < 3 * kSeeds; ++seed) {
        const std::set<std::string> of_scene = features(written(draw_scene(seed)));
        all.insert(of_scene.begin(), of_scene.end());
        for (auto a = of_scene.begin(); a != of_scene.end(); ++a) {
            for (auto b = std::next(a); b != of_scene.end(); ++b) {
                pairs.insert({*a, *b});
            }
        }
    }
    EXPECT_GT(all.size(), 55U);
    for (auto a = all.begin(); a != all.end(); ++a) {
        for (auto b = std::next(a); b != all.end(); ++b) {
            EXPECT_TRUE(pairs.contains({*a, *b}) || is_impossible(*a, *b)) << *a << ", " << *b;
        }
    }
}

// ----------------------------------------------------------------------------- keys by their paths

// Gives a path of keys this value wherever it leads; whether it leads somewhere on every way that
// has all of it but the last key.
bool set_at(Json& tree, const std::string& path, const Json& value) {
    if (tree.is_array()) {
        const auto set = [&](bool all, Json& entry) { return set_at(entry, path, value) && all; };
        return std::accumulate(tree.begin(), tree.end(), true, set);
    }
    const auto dot = path.find('.');
    const std::string head = path.substr(0, dot);
    if (!tree.is_object() || !tree.contains(head)) {
        return dot != std::string::npos || !tree.is_object();
    }
    if (dot != std::string::npos) {
        return set_at(tree[head], path.substr(dot + 1), value);
    }
    tree[head] = value;
    return true;
}

// What a path leads to first; null if nowhere.
Json first_at(const Json& tree, const std::string& path) {
    if (path.empty()) {
        return tree;
    }
    if (tree.is_array()) {
        for (const Json& entry : tree) {
            if (const Json found = first_at(entry, path); !found.is_null()) {
                return found;
            }
        }
        return {};
    }
    const auto dot = path.find('.');
    const std::string head = path.substr(0, dot);
    return tree.is_object() && tree.contains(head)
               ? first_at(tree[head], dot == std::string::npos ? "" : path.substr(dot + 1))
               : Json();
}

// What reads as a scene; "refused: " and the reason for what does not.
template <typename Read>
std::string text_or_refused(const Read& read) {
    try {
        return runs::scene_text(read());
    } catch (const Error& error) {
        return std::string("refused: ") + error.what();
    }
}

TEST(WithKeys, MakeTheSceneThatAFileWithTheirValuesHas) {
    std::set<std::string> paths;
    std::size_t refused = 0;
    for (std::uint64_t seed = 0; seed < 150; ++seed) {
        const Json scene = written(draw_scene(seed));
        const Json other = written(draw_scene(seed + 10'000));
        const simulator::Scene read = runs::parse_scene(toml_text(scene), "drawn", "");
        for (const std::string& path : key_paths(scene)) {
            Json edited = scene;
            Json value = first_at(other, path);
            value = value.is_null() ? first_at(scene, path) : value;
            if (!set_at(edited, path, value)) {
                continue;
            }
            const std::string expected =
                text_or_refused([&] { return runs::parse_scene(toml_text(edited), "drawn", ""); });
            const std::string found = text_or_refused([&] {
                const auto set =
                    runs::with_keys(read, {{.path = path, .value = inline_text(value)}});
                return runs::parse_scene(runs::scene_text(set), "set", "");
            });
            const bool is_refused = expected.starts_with("refused: ");
            // A file may not have keys that do not apply any more; of a scene they just go.
            const bool has_idle_keys = expected.find("\" goes with ") != std::string::npos;
            if (!has_idle_keys) {
                EXPECT_EQ(found.starts_with("refused: "), is_refused)
                    << seed << " " << path << " = " << value.dump() << "\n"
                    << expected << "\n"
                    << found;
                EXPECT_TRUE(is_refused || found == expected) << seed << " " << path;
            }
            paths.insert(path);
            refused += is_refused ? 1 : 0;
        }
    }
    EXPECT_GT(paths.size(), 100U);
    EXPECT_GT(refused, 100U);
}

TEST(MeshNames, SayAllOfAMesh) {
    for (const char* kind : {"box", "layered", "regions", "fork", "simplex", "pieces",
                             "quadratic-layered", "quadratic-regions"}) {
        for (const char* rest : {"-3x2x1-0.6x0.4x0.2.pent", "-3x2x1x1-0.6x0.4x0.2x0.3.pent"}) {
            const MeshName name = parse_mesh_name(std::string(kind) + rest);
            EXPECT_EQ(text_of(name), std::string(kind) + rest);
            if (name.dimension == 3) {
                EXPECT_NO_THROW(validate(make_mesh<3>(name), kind));
            } else {
                EXPECT_NO_THROW(validate(make_mesh<4>(name), kind));
            }
        }
    }
    EXPECT_THROW(static_cast<void>(parse_mesh_name("torus-1x1x1-1x1x1.pent")), Error);
}

// ------------------------------------------------------------------------------------ the shrinker

TEST(Shrink, LeavesWhatAFailureTakesAndNothingElse) {
    const auto fails = [](const Json& scene) {
        const Json obstacles = scene.value("obstacle", Json::array());
        return value_at(scene, "contact.friction") > 0 && !obstacles.empty()
               && obstacles[0].contains("half_space") && scene.at("body").size() > 1;
    };
    int found = 0;
    for (std::uint64_t seed = 0; found < 5; ++seed) {
        const Json scene = draw_scene(seed);
        if (!fails(scene)) {
            continue;
        }
        ++found;
        const Json least = shrink(scene, fails, 2000);
        EXPECT_EQ(least["body"].size(), 2U);
        EXPECT_EQ(least["obstacle"].size(), 1U);
        EXPECT_EQ(least["contact"].size(), 1U) << toml_text(least);
        for (const char* block : {"constraint", "damping", "sleep", "solver", "output"}) {
            EXPECT_TRUE(least.value(block, Json::array()).empty()) << block;
        }
    }
}

// ---------------------------------------------------------------------------- what laws stand upon

TEST(RunInChild, TellsEndsApart) {
    const test::TempFolder folder;
    const auto end_of = [&](const std::function<void()>& work) {
        return run_in_child(work, folder / "log", 1).ended;
    };
    EXPECT_EQ(end_of([] {}), Ended::Well);
    EXPECT_EQ(end_of([] { throw Error("no"); }), Ended::Refused);
    EXPECT_EQ(end_of([] { throw std::out_of_range("at()"); }), Ended::Broken);
    EXPECT_EQ(end_of([] { raise(SIGKILL); }), Ended::Killed);
    EXPECT_EQ(end_of([] { std::abort(); }), Ended::Broken);
    EXPECT_EQ(end_of([] {
                  volatile bool is_forever = true;
                  while (is_forever) {
                  }
              }),
              Ended::Broken);
}

TEST(RunInChild, GivesTheMessageOfARefusalAlone) {
    const test::TempFolder folder;
    const ChildResult result = run_in_child(
        [] {
            std::fputs("noise", stderr);
            throw Error("one line");
        },
        folder / "log", 1);
    EXPECT_EQ(result.text, "one line");
}

class Folders : public testing::Test {
protected:
    void write(const std::string& name, const std::string& text) const {
        fs::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name) << text;
    }
    [[nodiscard]] std::string difference(Apart apart) const {
        return first_difference(folder_ / "a", folder_ / "b", apart);
    }
    test::TempFolder folder_;
};

TEST_F(Folders, DifferInAByteOrAFile) {
    for (const std::string run : {"a/", "b/"}) {
        write(run + "frames/x.pent", "same");
        write(run + "report.json", "{}");
        write(run + "journal.txt", "");
    }
    EXPECT_EQ(difference(Apart::TimesAndWork), "");
    write("b/frames/x.pent", "sane");
    EXPECT_NE(difference(Apart::TimesAndWork), "");
    write("b/frames/x.pent", "same");
    write("b/contacts/1.csv", "");
    EXPECT_NE(difference(Apart::TimesAndWork), "");
}

TEST_F(Folders, DifferInReportsButForTimes) {
    write("a/journal.txt", "");
    write("b/journal.txt", "");
    write("a/report.json", R"({"seconds": 1, "steps": [{"step": 1, "candidates": 3}]})");
    write("b/report.json", R"({"seconds": 2, "steps": [{"step": 1, "candidates": 4}]})");
    EXPECT_NE(difference(Apart::Times), "");
    EXPECT_EQ(difference(Apart::TimesAndWork), "");
    write("b/report.json", R"({"seconds": 2, "steps": [{"step": 2, "candidates": 3}]})");
    EXPECT_NE(difference(Apart::TimesAndWork), "");
}

TEST_F(Folders, DifferInJournalsButForTimesAndParts) {
    write("a/report.json", "{}");
    write("b/report.json", "{}");
    write("a/journal.txt",
          "01234567 {\"part\": {\"isa\": 1}}\n01234567 {\"step\": {\"seconds\": 1}}\n");
    write("b/journal.txt",
          "76543210 {\"part\": {\"isa\": 1}}\n76543210 {\"step\": {\"seconds\": 2}}\n");
    EXPECT_EQ(difference(Apart::Times), "");
    write("b/journal.txt", "76543210 {\"step\": {\"seconds\": 2}}\n");
    EXPECT_NE(difference(Apart::Times), "");
    EXPECT_EQ(difference(Apart::TimesAndWork), "");
    write("b/journal.txt", "76543210 {\"step\": {\"step\": 2}}\n");
    EXPECT_NE(difference(Apart::TimesAndWork), "");
}

TEST(WhatIsLost, IsAKeyOrAValue) {
    const Json scene = {{"contact", {{"friction", 0.5}, {"slip_speed", 0.01}}}};
    EXPECT_EQ(what_is_lost(scene, scene), "");
    EXPECT_NE(what_is_lost(scene, {{"contact", {{"friction", 0.5}}}}), "");
    EXPECT_NE(what_is_lost(scene, {{"contact", {{"friction", 0.5}, {"slip_speed", 0.001}}}}), "");
}

TEST_F(Folders, OfARunShowWorkOfWhatIsOff) {
    const Json scene = {{"scene", {{"gravity", {0.0, 0.0, 0.0}}}},
                        {"body", {{{"name", "a"}}}},
                        {"solver", {{"integrator", "linear_euler"}}},
                        {"output", {{"contact_pairs", false}}}};
    const std::string zero =
        R"("energies": {"kinetic": 1, "elastic": 1}, "damping_hessians": 0,
           "activation_work": 0, "asleep": 0,
           "newton_iterations": 0, "unbalanced": 0,
           "contact": {"point_facet": 0, "mixed": 0, "self": 0,
           "searches": 0, "candidates": 0, "trees_built": 0, "trees_refit": 0, "ccd_seconds": 0,
           "stiffness": 0, "obstacle": 0, "obstacle_tests": 0, "seconds": 0, "deepest": 0,
           "friction": )";
    write("a/report.json", R"({"steps": [{"step": 1, )" + zero + "0}}]}");
    EXPECT_EQ(work_of_what_is_off(scene, folder_ / "a"), "");
    write("a/report.json", R"({"steps": [{"step": 1, )" + zero + "2}}]}");
    EXPECT_EQ(work_of_what_is_off(scene, folder_ / "a"),
              "contact.friction of step 1 is 2 without friction");
    write("a/report.json", R"({"steps": [{"step": 1, "energies": {"gravity": 0}, )"
                               + zero.substr(zero.find("\"damping_hessians\"")) + "0}}]}");
    EXPECT_EQ(work_of_what_is_off(scene, folder_ / "a"),
              "step 1 has the energy of gravity without gravity");
}

// ----------------------------------------------------------------------------------------- samples

std::vector<std::string> samples() {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(PENT_SCENE_SAMPLES)) {
        names.push_back(entry.path().stem().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

class Sample : public testing::TestWithParam<std::string> {};

// Scenes that broke a law once: what was wrong stands at the top of each.
TEST_P(Sample, KeepsEveryLaw) {
    const Json scene =
        parse_document(text_of_file(fs::path(PENT_SCENE_SAMPLES) / (GetParam() + ".toml")));
    const test::TempFolder folder;
    const Checked checked = check(scene, folder.path());
    EXPECT_FALSE(checked.finding) << checked.finding->law << ": " << checked.finding->what;
}

INSTANTIATE_TEST_SUITE_P(SceneFuzz, Sample, testing::ValuesIn(samples()), [](const auto& sample) {
    std::string name = sample.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

}  // namespace
}  // namespace pent::scene_fuzz
