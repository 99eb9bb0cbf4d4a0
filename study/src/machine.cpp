#include "machine.h"

#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <sys/utsname.h>

namespace pent::study {

Machine this_machine() {
    utsname system{};
    ::uname(&system);
    std::ifstream file("/proc/cpuinfo");
    const std::string model = model_name({std::istreambuf_iterator<char>(file), {}});
    // Not every system names the model.
    return {.node = system.nodename, .processor = model.empty() ? system.machine : model};
}

std::string model_name(const std::string& cpuinfo) {
    std::istringstream lines(cpuinfo);
    std::string line;
    while (std::getline(lines, line)) {
        if (line.rfind("model name", 0) == 0) {
            const std::size_t value = line.find_first_not_of(" \t", line.find(':') + 1);
            return value == std::string::npos ? "" : line.substr(value);
        }
    }
    return "";
}

std::string mixture_warning(const std::vector<Machine>& runs) {
    std::map<std::string, int> counts;
    for (const Machine& machine : runs) {
        ++counts[machine.processor];
    }
    if (counts.size() < 2) {
        return "";
    }
    std::string list;
    for (const auto& [processor, count] : counts) {
        list += (list.empty() ? "" : ", ") + processor + ": " + std::to_string(count)
                + (count == 1 ? " run" : " runs");
    }
    return "times are of different processors (" + list
           + ") and do not compare; errors do. Run all units on one kind for a frontier";
}

}  // namespace pent::study
