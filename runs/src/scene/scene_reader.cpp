#include "scene/block_keys.h"
#include "scene/part_reader.h"

#include <pent/error.h>
#include <pent/read_text.h>
#include <pent/runs/scene_file.h>

#include <algorithm>
#include <type_traits>

namespace pent::runs {

namespace {

// What a block needs beside its keys, before and behind them.
struct BlockReader {
    TableReader& table;  // of the whole file
    Scene& scene;
    const std::filesystem::path& folder;

    template <typename Part>
    void operator()(std::string_view name, std::vector<Part>& parts) const {
        for (TableReader& entry : table.tables(name)) {
            read_part(entry, parts.emplace_back(), scene.dimension);
            finish(entry, parts.back());
        }
    }
    template <typename Part>
    void operator()(std::string_view name, std::optional<Part>& part) const {
        if (table.has(name)) {
            (*this)(name, part.emplace());
        }
    }
    template <typename Part>
    void operator()(std::string_view name, Part& part) const {
        if (table.has(name)) {
            TableReader block = table.table(name);
            static_cast<void>(read_block_keys(scene, block, part));
            read_part(block, part, scene.dimension);
        }
    }

private:
    void finish(const TableReader& /*entry*/, const Obstacle& /*obstacle*/) const {}
    void finish(const TableReader& entry, Body& body) const;
    template <typename Part>
    requires requires(Part part) { part.select; }
    void finish(const TableReader& entry, Part& part) const {
        check_name(entry, "body", part.body);
        if constexpr (std::is_same_v<Part, Attachment>) {
            check_name(entry, "target", part.target.empty() ? part.body : part.target);
        }
        part.source = entry.place("select");
        if (part.select.empty()) {
            entry.fail("select", entry.name()
                                     + " needs \"select\" (a table, a list of tables, or"
                                       " \"everything\")");
        }
    }
    void check_name(const TableReader& entry, std::string_view key, const std::string& name) const;
};

void BlockReader::finish(const TableReader& entry, Body& body) const {
    body.mesh = (folder / body.mesh).lexically_normal().string();
    body.source = entry.place("mesh");
    try {
        Scene probe;
        probe.dimension = scene.dimension;
        probe.gravity = Eigen::VectorXd::Zero(scene.dimension);
        probe.bodies = {body};
        check(probe);
    } catch (const Error& error) {
        entry.fail("name", error.what());
    }
    try {
        check_regions(body);
    } catch (const Error& error) {
        entry.fail("region", error.what());
    }
    const auto has_name = [&](const Body& other) { return other.name == body.name; };
    if (std::count_if(scene.bodies.begin(), scene.bodies.end(), has_name) > 1) {
        entry.fail("name", "two bodies have the name \"" + body.name + "\"");
    }
}

// Whether a body has this name.
void BlockReader::check_name(const TableReader& entry,
                             std::string_view key,
                             const std::string& name) const {
    std::vector<std::string> names;
    for (const Body& body : scene.bodies) {
        names.push_back(body.name);
    }
    if (std::find(names.begin(), names.end(), name) == names.end()) {
        entry.fail(key, "no body is called \"" + name + "\"" + did_you_mean(name, names));
    }
}

// What several blocks decide together is said at the one that asks for it.
void check_together(TableReader& reader, const Scene& scene) {
    const auto check_at = [](const TableReader& block, std::string_view key, const auto& action) {
        try {
            action();
        } catch (const Error& error) {
            block.fail(key, error.what());
        }
    };
    if (scene.contact) {
        check_at(reader.table("contact"), "model",
                 [&] { check_model(scene.contact->model, scene.solver.integrator); });
        check_at(reader.table("contact"), "ignore",
                 [&] { check_pairs(scene.contact->ignore, scene); });
        check_at(reader.table("contact"), "only", [&] { check_pairs(scene.contact->only, scene); });
    }
    check_at(reader, "activation", [&] { check_activations(scene); });
    if (scene.sleep) {
        check_at(reader, "sleep", [&] { check_sleeping(scene.solver.integrator); });
    }
    const std::vector<TableReader> bodies = reader.tables("body");
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        check_at(bodies[i], "name", [&] { check_held(scene.bodies[i], scene); });
    }
}

}  // namespace

Scene parse_scene(std::string_view text,
                  const std::string& name,
                  const std::filesystem::path& folder) {
    const toml::table table = parse_toml(text, name);
    TableReader reader(table, "the scene", name);
    Scene scene;
    PartReader{reader, scene.dimension}(simulator::key("scene"), scene);
    blocks(scene, BlockReader{reader, scene, folder});
    reader.finish([](const std::string& key) { return owners_text(key); });
    if (scene.bodies.empty()) {
        reader.fail("", "the scene has no [[body]]");
    }
    check_together(reader, scene);
    check(scene);
    return scene;
}

Scene read_scene(const std::filesystem::path& path) {
    return parse_scene(read_text(path, "a scene file (TOML)"), path.string(), path.parent_path());
}

}  // namespace pent::runs
