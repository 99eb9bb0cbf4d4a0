#include "pent/viewer/text.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <pent/error.h>

namespace pent::viewer {

namespace {

// Whether the font found when the program was built opens, or else one where Debian puts it.
bool open_font(FT_Library library, FT_Face& face) {
    return FT_New_Face(library, PENT_FONT, 0, &face) == 0
           || FT_New_Face(library, "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", 0, &face)
                  == 0;
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

    // The rendered glyph of a character; a box where the font has none.
    [[nodiscard]] FT_GlyphSlot load(char character) const {
        FT_Load_Char(face, static_cast<unsigned char>(character), FT_LOAD_RENDER);
        return face->glyph;
    }
};

Font::Font(int pixels) : face_(std::make_unique<Face>()) {
    face_->pixels = pixels;
    if (FT_Init_FreeType(&face_->library) != 0 || !open_font(face_->library, face_->face)
        || FT_Set_Pixel_Sizes(face_->face, 0, static_cast<FT_UInt>(pixels)) != 0) {
        // GCOVR_EXCL_START: a machine without the font
        throw Error(
            "captions: font DejaVuSans.ttf not found; install the package fonts-dejavu-core, or "
            "switch captions off");
        // GCOVR_EXCL_STOP
    }
}

Font::~Font() = default;

int Font::pixels() const {
    return face_->pixels;
}

int Font::width(std::string_view line) const {
    FT_Pos width = 0;
    for (const char character : line) {
        width += face_->load(character)->advance.x;
    }
    return static_cast<int>(width / 64);
}

void Font::draw(Image& image, int x, int y, std::string_view line, const Color& color) const {
    FT_Pos pen = static_cast<FT_Pos>(x) * 64;
    for (const char character : line) {
        const FT_GlyphSlot glyph = face_->load(character);
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
