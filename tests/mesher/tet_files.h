#pragma once

#include "shapes.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/mesher/read_tetrahedra.h>

#include <string>

namespace pent::test {

/// What a file of this name has that consists of a text.
inline mesher::TetrahedraFile read_text(const std::string& name, const std::string& text) {
    const TempFolder folder;
    write_file(folder / name, text);
    return mesher::read_tetrahedra(folder / name);
}

/// The message by which it is refused.
inline std::string message_for(const std::string& name, const std::string& text) {
    return error_of([&] { static_cast<void>(read_text(name, text)); });
}

}  // namespace pent::test
