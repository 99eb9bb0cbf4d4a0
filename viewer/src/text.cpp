#include "pent/viewer/text.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <pent/error.h>

#include <filesystem>
#include <string>

namespace pent::viewer {

namespace {

std::string font_path() {
    for (const char* path : {PENT_FONT, "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"}) {
        std::error_code error;
        if (std::filesystem::is_regular_file(path, error)) {
            return path;
        }
    }
    throw Error(
        "captions: font DejaVuSans.ttf not found; install the package fonts-dejavu-core, or "
        "switch captions off");
}

}  // namespace

struct Font::Face {
    FT_Library library = nullptr;
    FT_Face face = nullptr;
    int pixels = 0;

    Face() = default;
    ~Face() {
        FT_Done_Face(face);
        FT_Done_FreeType(library);
    }
    Face(const Face&) = delete;
    Face& operator=(const Face&) = delete;
    Face(Face&&) = delete;
    Face& operator=(Face&&) = delete;

    // Loads and renders the glyph of a character; false if the font has none.
    [[nodiscard]] bool load(char character) const {
        return FT_Load_Char(face, static_cast<unsigned char>(character), FT_LOAD_RENDER) == 0;
    }
};

Font::Font(int pixels) : face_(std::make_unique<Face>()) {
    const std::string path = font_path();
    face_->pixels = pixels;
    if (FT_Init_FreeType(&face_->library) != 0
        || FT_New_Face(face_->library, path.c_str(), 0, &face_->face) != 0
        || FT_Set_Pixel_Sizes(face_->face, 0, static_cast<FT_UInt>(pixels)) != 0) {
        throw Error(path + ": cannot be used as a font");
    }
}

Font::~Font() = default;
Font::Font(Font&&) noexcept = default;
Font& Font::operator=(Font&&) noexcept = default;

int Font::pixels() const {
    return face_->pixels;
}

int Font::width(std::string_view line) const {
    FT_Pos width = 0;
    for (const char character : line) {
        if (face_->load(character)) {
            width += face_->face->glyph->advance.x;
        }
    }
    return static_cast<int>(width / 64);
}

void Font::draw(Image& image, int x, int y, std::string_view line, const Color& color) const {
    FT_Pos pen = static_cast<FT_Pos>(x) * 64;
    for (const char character : line) {
        if (!face_->load(character)) {
            continue;
        }
        const FT_GlyphSlot glyph = face_->face->glyph;
        const FT_Bitmap& bitmap = glyph->bitmap;
        const int left = static_cast<int>(pen / 64) + glyph->bitmap_left;
        for (unsigned row = 0; row < bitmap.rows; ++row) {
            for (unsigned column = 0; column < bitmap.width; ++column) {
                const unsigned char cover =
                    bitmap.buffer[row * static_cast<unsigned>(bitmap.pitch) + column];
                if (cover > 0) {
                    blend(image, left + static_cast<int>(column),
                          y - glyph->bitmap_top + static_cast<int>(row), color,
                          static_cast<float>(cover) / 255.0F);
                }
            }
        }
        pen += glyph->advance.x;
    }
}

}  // namespace pent::viewer
