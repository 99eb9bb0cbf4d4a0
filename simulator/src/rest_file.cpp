#include "rest_file.h"

#include <pent/error.h>
#include <pent/output_file.h>

#include <fstream>
#include <nlohmann/json.hpp>

namespace pent::simulator {

using Json = nlohmann::ordered_json;

void write_rest(const std::filesystem::path& path,
                const std::vector<std::string>& bodies,
                const std::vector<BodyRest>& rest) {
    Json json = Json::object();
    for (std::size_t body = 0; body < bodies.size(); ++body) {
        json[bodies[body]] = {{"is_asleep", rest[body].is_asleep},
                              {"quiet_steps", rest[body].quiet_steps}};
    }
    write_text(path, json.dump(1) + "\n");
}

std::vector<BodyRest> read_rest(const std::filesystem::path& path,
                                const std::vector<std::string>& bodies) {
    std::ifstream file(path);
    try {
        const Json json = Json::parse(file);
        std::vector<BodyRest> rest(bodies.size());
        for (std::size_t body = 0; body < bodies.size(); ++body) {
            const Json& entry = json.at(bodies[body]);
            entry.at("is_asleep").get_to(rest[body].is_asleep);
            rest[body].quiet_steps =
                entry.at("quiet_steps").get_ref<const Json::number_unsigned_t&>();
        }
        return rest;
    } catch (const nlohmann::json::exception&) {
        throw Error(path.string()
                    + ": does not say which bodies sleep; remove the last frame to go on from the one"
                      " before, or use --force to start again");
    }
}

}  // namespace pent::simulator
