#include "scene/block_keys.h"
#include "scene/part_reader.h"
#include "scene/schema_table.h"

#include <pent/error.h>
#include <pent/runs/scene_keys.h>

#include <algorithm>
#include <type_traits>
#include <utility>
#include <variant>

namespace pent::runs {

namespace {

using simulator::Field;

struct AnyVisit {
    template <typename Value>
    void operator()(const Field& /*field*/, const Value& /*member*/) const {}
};

// Has keys of its own.
template <typename Part>
concept HasFields = requires(Part& part) {
    simulator::fields(part, AnyVisit());
};

template <typename Value>
constexpr bool kIsText =
    std::is_enum_v<Value> || std::is_same_v<Value, std::string> || std::is_same_v<Value, Plane>;

// A table of this one key. What is no value of TOML is a text without its quotes.
toml::table table_of(std::string_view key, const std::string& value, bool is_text) {
    toml::table table;
    if (!is_text || value.starts_with('"') || value.starts_with('\'')) {
        try {
            table = parse_toml("value = " + value, "");
        } catch (const Error&) {
            table.clear();
        }
    }
    toml::table result;
    if (table.size() == 1) {
        result.insert(key, *table.get("value"));
    } else {
        result.insert(key, value);
    }
    return result;
}

// The keys of a part that it has to have as it is now.
template <typename Part>
std::vector<std::string_view> required_keys(Part& part) {
    std::vector<std::string_view> keys;
    simulator::fields(part, [&](const Field& field, const auto& /*member*/) {
        if (field.is_required && field.does_apply) {
            keys.push_back(field.key);
        }
    });
    return keys;
}

// What is done with a key of a scene.
struct Setting {
    const KeyValue& key;
    const int& dimension;                  // of the scene
    int count = 0;                         // of what it has been done to
    std::vector<std::string> needed = {};  // paths of what others have to say now
};

// A visitor of the schema: gives what a path leads to within a part a value.
struct KeySetter {
    std::string_view path;  // what is left of it
    Setting& setting;

    template <typename Value>
    void operator()(const Field& field, Value& member) const {
        if (field.key != head()) {
            return;
        }
        if (is_last()) {
            set(field, member);
        } else {
            inner(head()).enter(member);
        }
    }
    // One of a pair, beside the other as it is.
    void operator()(const Field& field, simulator::Lame& lame) const {
        using namespace simulator;
        const bool is_young = path == kYoung.key || path == kPoisson.key;
        if (!is_young && path != kMu.key && path != kLambda.key) {
            return;
        }
        toml::table table = table_of(path, setting.key.value, false);
        const YoungPoisson young = young_from_lame(setting.dimension, lame);
        const auto keep = [&](const Field& key, double number) { table.emplace(key.key, number); };
        keep(is_young ? kYoung : kMu, is_young ? young.young : lame.mu);
        keep(is_young ? kPoisson : kLambda, is_young ? young.poisson : lame.lambda);
        read(table, field, lame);
    }
    // Its name is the key.
    void operator()(const Field& /*field*/, ObstacleShape& shape) const {
        if (head() != name_of<Eigen::Dynamic>(shape)) {
            return;
        }
        if (is_last()) {
            const toml::table table = table_of(path, setting.key.value, false);
            TableReader reader(table, "the scene", "");
            PartReader{reader, setting.dimension}.read_shape(shape);
            ++setting.count;
            return;
        }
        std::visit([&](auto& one) { inner(head()).enter(one); }, shape);
    }

    template <typename Part>
    void enter(Part& part) const {
        if constexpr (HasFields<Part>) {
            const std::vector<std::string_view> before = required_keys(part);
            simulator::fields(part, *this);
            const std::string& whole = setting.key.path;
            for (const std::string_view key : required_keys(part)) {
                if (std::find(before.begin(), before.end(), key) == before.end()) {
                    setting.needed.push_back(whole.substr(0, whole.size() - path.size())
                                             + std::string(key));
                }
            }
        }
    }
    template <typename Part>
    void enter(std::vector<Part>& parts) const {
        for (Part& part : parts) {
            enter(part);
        }
    }
    void enter(Selection& selection) const {
        const std::string_view kind = simulator::kSelectionNames[selection.index()];
        if (std::holds_alternative<RegionSelection>(selection)) {  // its key is its name
            std::visit([&](auto& one) { enter(one); }, selection);
        } else if (kind == head() && !is_last()) {
            std::visit([&](auto& one) { inner(kind).enter(one); }, selection);
        }
    }

private:
    [[nodiscard]] std::string_view head() const { return path.substr(0, path.find('.')); }
    [[nodiscard]] KeySetter inner(std::string_view name) const {
        return {path.substr(name.size() + 1), setting};
    }
    [[nodiscard]] bool is_last() const { return head().size() == path.size(); }

    template <typename Value>
    void set(const Field& field, Value& member) const {
        read(table_of(field.key, setting.key.value, kIsText<Value>), field, member);
    }
    template <typename Value>
    void read(const toml::table& table, const Field& field, Value& member) const {
        TableReader reader(table, "the scene", "");
        refuse_if_idle(reader, field);
        Value fresh{};
        PartReader{reader, setting.dimension}(field, fresh);
        member = std::move(fresh);
        ++setting.count;
    }
};

// The same for a whole scene.
struct BlockSetter {
    const Scene& scene;
    std::string_view block;
    const KeySetter& setter;
    bool& is_there;

    template <typename Part>
    void operator()(std::string_view name, std::vector<Part>& parts) const {
        for (Part& part : parts) {
            (*this)(name, part);
        }
    }
    template <typename Part>
    void operator()(std::string_view name, std::optional<Part>& part) const {
        if (part) {
            (*this)(name, *part);
        }
    }
    template <typename Part>
    void operator()(std::string_view name, Part& part) const {
        if (name != block) {
            return;
        }
        is_there = true;
        const std::string_view key = setter.path;
        const toml::table table = table_of(key, setter.setting.key.value, key == kPreset.key);
        TableReader reader(table, "the scene", "");
        if (read_block_keys(scene, reader, part)) {
            ++setter.setting.count;
        } else {
            setter.enter(part);
        }
    }
};

std::string path_of(const SchemaRow& row) {
    const auto name = row.block.find_last_of('[') + 1;
    return row.block.substr(name, row.block.find(']') - name) + "."
           + row.key.substr(0, row.key.find(' '));
}

// The paths of keys that have to be there now and had not to be before.
std::vector<std::string> set_key(Scene& scene, const SchemaRow& row, const KeyValue& key) {
    const std::string_view whole = key.path;
    const std::string_view block = whole.substr(0, whole.find('.'));
    Setting setting{key, scene.dimension};
    bool is_there = false;
    const KeySetter setter{whole.substr(block.size() + 1), setting};
    const BlockSetter set_in{scene, block, setter, is_there};
    set_in("scene", scene);
    blocks(scene, set_in);
    if (setting.count == 0) {
        const std::string path = is_there ? " with \"" + std::string(setter.path) + "\"" : "";
        throw Error("the scene has no " + row.block + path);
    }
    return setting.needed;
}

}  // namespace

std::vector<std::string> scene_keys() {
    std::vector<std::string> paths;
    for (const SchemaRow& row : schema_rows()) {
        paths.push_back(path_of(row));
    }
    return paths;
}

Scene with_keys(Scene scene, const std::vector<KeyValue>& keys) {
    const std::vector<SchemaRow> rows = schema_rows();
    std::vector<std::pair<const SchemaRow*, const KeyValue*>> found;
    for (const KeyValue& key : keys) {
        const auto row = std::find_if(rows.begin(), rows.end(), [&](const SchemaRow& one) {
            return path_of(one) == key.path;
        });
        if (row == rows.end()) {
            const std::string near = did_you_mean(key.path, scene_keys());
            throw Error("no key of scenes has the path \"" + key.path + "\"" + near);
        }
        found.emplace_back(&*row, &key);
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<std::string> needed;
    for (const auto& [row, key] : found) {
        std::erase(needed, key->path);
        const std::vector<std::string> more = set_key(scene, *row, *key);
        needed.insert(needed.end(), more.begin(), more.end());
    }
    if (!needed.empty()) {
        throw Error("the scene needs \"" + needed.front() + "\", too");
    }
    check(scene);
    return scene;
}

}  // namespace pent::runs
