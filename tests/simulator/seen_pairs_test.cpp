#include <pent/simulator/seen_pairs.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace pent::simulator {
namespace {

using Random = std::mt19937;

std::uint32_t below(std::uint32_t count, Random& random) {
    return std::uniform_int_distribution<std::uint32_t>(0, count - 1)(random);
}

// Names in no order, so that places of bodies are not those of their names.
Scene scene_of(std::uint32_t bodies, Random& random) {
    Scene scene;
    for (std::uint32_t i = 0; i < bodies; ++i) {
        scene.bodies.emplace_back().name = "body" + std::to_string(i);
    }
    std::shuffle(scene.bodies.begin(), scene.bodies.end(), random);
    scene.contact.emplace();
    return scene;
}

std::vector<BodyPair> some_pairs(const Scene& scene, std::uint32_t count, Random& random) {
    const auto bodies = static_cast<std::uint32_t>(scene.bodies.size());
    std::vector<BodyPair> pairs;
    for (std::uint32_t i = 0; i < count; ++i) {
        pairs.push_back(
            {scene.bodies[below(bodies, random)].name, scene.bodies[below(bodies, random)].name});
    }
    return pairs;
}

bool are(const std::string& x, const std::string& y, const std::string& a, const std::string& b) {
    return (x == a && y == b) || (x == b && y == a);
}

// What the documentation of the keys says, by names.
bool are_seen(const Scene& scene, const std::string& a, const std::string& b) {
    const ContactSettings& contact = *scene.contact;
    bool is_ignored = a == b && !contact.self;
    for (const BodyPair& pair : contact.ignore) {
        is_ignored = is_ignored || are(pair.first, pair.second, a, b);
    }
    for (const Attachment& tie : scene.attachments) {
        is_ignored = is_ignored || (!tie.contact && are(tie.body, tie.target, a, b));
    }
    bool is_asked_for = contact.only.empty();
    for (const BodyPair& pair : contact.only) {
        is_asked_for = is_asked_for || are(pair.first, pair.second, a, b);
    }
    return is_asked_for && !is_ignored;
}

TEST(SeenPairs, AreThoseThatIgnoreOnlySelfAndAttachmentsLeave) {
    Random random(1);
    std::vector<int> answers(2, 0);
    for (int trial = 0; trial < 200; ++trial) {
        Scene scene = scene_of(1 + below(8, random), random);
        scene.contact->self = below(2, random) == 0;
        scene.contact->ignore = some_pairs(scene, below(6, random), random);
        scene.contact->only = some_pairs(scene, below(3, random) * 8, random);
        for (const BodyPair& pair : some_pairs(scene, below(4, random), random)) {
            Attachment& tie = scene.attachments.emplace_back();
            tie.body = pair.first;
            tie.target = below(3, random) == 0 ? "" : pair.second;
            tie.contact = below(2, random) == 0;
        }
        const SeenPairs seen(scene);
        for (std::uint32_t a = 0; a < scene.bodies.size(); ++a) {
            for (std::uint32_t b = 0; b < scene.bodies.size(); ++b) {
                const bool expected = are_seen(scene, scene.bodies[a].name, scene.bodies[b].name);
                EXPECT_EQ(seen.may_touch(a, b), expected) << trial << ": " << a << ", " << b;
                ++answers[expected ? 1 : 0];
            }
        }
    }
    EXPECT_GT(answers[0], 500);
    EXPECT_GT(answers[1], 500);
}

}  // namespace
}  // namespace pent::simulator
