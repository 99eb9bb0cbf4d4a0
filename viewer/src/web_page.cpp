#include "web_page.h"

#include <pent/error.h>
#include <pent/read_text.h>

namespace pent::viewer {

std::string read_web_page(const std::filesystem::path& path) {
    std::string page = read_text(path,
                                 "the page of the viewer; build the page with scripts/web.sh, or"
                                 " say where it is with --page");
    const std::size_t mark = page.find(kRunMark);
    if (mark == std::string::npos || page.find(kRunMark, mark + 1) != std::string::npos) {
        throw Error(path.string()
                    + ": is not the page of the viewer; expected web/dist/index.html as "
                      "scripts/web.sh builds it");
    }
    return page;
}

}  // namespace pent::viewer
