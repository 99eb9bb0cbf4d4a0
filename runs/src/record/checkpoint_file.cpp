#include "record/checkpoint_file.h"

#include <pent/crc32c.h>
#include <pent/error.h>
#include <pent/output_file.h>
#include <pent/read_text.h>

#include <cstring>

namespace pent::runs {

namespace {

constexpr std::string_view kMagic = "pent checkpoint 1\n";

template <typename Number>
void add(std::string& text, Number number) {
    text.append(reinterpret_cast<const char*>(&number), sizeof number);
}

// Reads a text from its beginning; throws an Error where it ends too soon.
class Cursor {
public:
    explicit Cursor(std::string_view text) : left_(text) {}

    [[nodiscard]] bool is_at_end() const { return left_.empty(); }

    std::string_view take(std::uint64_t bytes) {
        if (bytes > left_.size()) {
            throw Error("it ends too soon");
        }
        const std::string_view part = left_.substr(0, bytes);
        left_.remove_prefix(bytes);
        return part;
    }

    std::uint64_t number() {
        std::uint64_t value = 0;
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
        return value;
    }

private:
    std::string_view left_;
};

std::string_view checked_content(std::string_view text) {
    std::uint32_t sum = 0;
    if (text.size() < kMagic.size() + sizeof sum || text.substr(0, kMagic.size()) != kMagic) {
        throw Error("it is not a checkpoint");
    }
    const std::string_view content = text.substr(0, text.size() - sizeof sum);
    std::memcpy(&sum, text.data() + content.size(), sizeof sum);
    if (crc32c(content.data(), content.size()) != sum) {
        throw Error("its checksum does not fit");
    }
    return content.substr(kMagic.size());
}

}  // namespace

void write_checkpoint(const std::filesystem::path& path,
                      std::uint64_t frame,
                      std::uint64_t step,
                      const StateBlocks& blocks) {
    std::string text(kMagic);
    add(text, frame);
    add(text, step);
    for (const auto& [name, bytes] : blocks.all()) {
        add(text, std::uint64_t{name.size()});
        text += name;
        add(text, std::uint64_t{bytes.size()});
        text += bytes;
    }
    add(text, crc32c(text.data(), text.size()));
    write_text(path, text);
}

StateBlocks read_checkpoint(const std::filesystem::path& path,
                            std::uint64_t frame,
                            std::uint64_t step) {
    try {
        if (!std::filesystem::exists(path)) {
            throw Error("it is not there: checkpoints are kept of the last two frames alone");
        }
        const std::string text = read_text(path, "a checkpoint");
        Cursor cursor(checked_content(text));
        if (cursor.number() != frame || cursor.number() != step) {
            throw Error("it is of another frame or step");
        }
        StateBlocks blocks;
        while (!cursor.is_at_end()) {
            const std::string name(cursor.take(cursor.number()));
            blocks.put_bytes(name, std::string(cursor.take(cursor.number())));
        }
        return blocks;
    } catch (const Error& error) {
        throw Error(path.string() + ": cannot be gone on from: " + error.what()
                    + "; put it back, remove the last frame to go on from the one before, or use"
                      " --force to start again");
    }
}

}  // namespace pent::runs
