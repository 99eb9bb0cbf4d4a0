#pragma once

#include "moment.h"
#include "survey.h"

#include <pent/viewer/camera.h>
#include <pent/viewer/image.h>
#include <pent/viewer/project.h>
#include <pent/viewer/render.h>
#include <pent/viewer/render_run.h>
#include <pent/viewer/run_folder.h>
#include <pent/viewer/section.h>

#include <optional>
#include <string>
#include <vector>

namespace pent::viewer {

/// A surface that is shown, with what is needed to paint it.
struct Shown {
    Surface surface;
    Eigen::VectorXd values;  ///< Of the colored quantity, at its vertices.
    Positions<3> normals;    ///< 3 x 3 triangles; empty while only its extent is wanted.
    std::size_t body = 0;
    float opacity = 1;
    std::optional<Color> tint;  ///< In place of the body's color.
};

/// Makes the pictures of a run: it knows the bodies, what each tile of a picture shows, and, once
/// it has looked at all frames, the camera and the colors.
template <int Dim>
class Studio {
public:
    Studio(const RunFolder& run, const RenderRunOptions& options);

    /// Takes a frame into account for camera, floor and colors.
    void look_at(int frame);

    /// Settles camera and colors; to be called between look_at() and the pictures.
    void settle();

    /// Pictures a second at which the chosen frames play at their true speed; 30 for one moment.
    [[nodiscard]] double true_rate() const;

    [[nodiscard]] const Survey& survey() const { return survey_; }
    [[nodiscard]] ColorRange range() const { return range_; }

    /// How many tiles are side by side in a picture.
    [[nodiscard]] std::size_t tile_count() const { return tiles_.size(); }

    /// One frame, all tiles side by side.
    [[nodiscard]] Image picture(int frame) const;

    /// One frame, a single tile as large as the picture.
    [[nodiscard]] Image tile_picture(int frame, std::size_t tile) const;

    /// One tile of one frame for a contact sheet, smaller than a picture.
    ///
    /// @param has_bar  Whether this is the tile that shows the color bar, if there is one.
    [[nodiscard]] Image small_tile(int frame, std::size_t tile, bool has_bar) const;

private:
    // The sections a tile shows: one, or with onion skin all; `solid` is the one that is not a
    // ghost.
    struct Tile {
        std::vector<std::size_t> sections;
        std::size_t solid = 0;
        std::string label;
    };

    [[nodiscard]] std::vector<Tile> make_tiles() const;
    [[nodiscard]] std::vector<Shown> shown_in(const Tile& tile,
                                              const Moment<Dim>& moment,
                                              bool with_normals) const;
    [[nodiscard]] Shown slice_of(std::size_t body,
                                 const Tile& tile,
                                 std::size_t section,
                                 const Moment<Dim>& moment,
                                 bool with_normals) const;
    [[nodiscard]] Shown outline_of(std::size_t body,
                                   const Tile& tile,
                                   const Moment<Dim>& moment,
                                   bool with_normals) const;
    [[nodiscard]] Image paint(const Moment<Dim>& moment,
                              const Tile& tile,
                              const Camera& camera,
                              int width,
                              int height,
                              bool has_bar) const;
    [[nodiscard]] int tile_width(std::size_t tile) const;

    const RunFolder& run_;
    const RenderRunOptions& options_;
    std::vector<Body<Dim>> bodies_;
    Moment<Dim> start_;
    std::vector<Section> sections_;
    std::vector<Tile> tiles_;
    Survey survey_;
    ColorRange range_;
    CameraFit tile_fit_;
    CameraFit sheet_fit_;
    Camera tile_camera_;
    Camera sheet_camera_;
    Renderer renderer_;
};

}  // namespace pent::viewer
