#include "web_page.h"

#include <pent/error.h>

#include <fstream>
#include <iterator>

namespace pent::viewer {

std::string read_web_page(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        throw Error(path.string()
                    + ": cannot be read; build the page with scripts/web.sh, or say where it is "
                      "with --page");
    }
    std::string page(std::istreambuf_iterator<char>(file), {});
    const std::size_t mark = page.find(kRunMark);
    if (mark == std::string::npos || page.find(kRunMark, mark + 1) != std::string::npos) {
        throw Error(path.string()
                    + ": is not the page of the viewer; expected web/dist/index.html as "
                      "scripts/web.sh builds it");
    }
    return page;
}

}  // namespace pent::viewer
