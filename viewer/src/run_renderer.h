#pragma once

#include "framing.h"
#include "snapshot.h"
#include "survey.h"
#include "tile.h"

#include <pent/viewer/camera.h>
#include <pent/viewer/image.h>
#include <pent/viewer/obstacle_slice.h>
#include <pent/viewer/project.h>
#include <pent/viewer/render.h>
#include <pent/viewer/render_run.h>
#include <pent/viewer/run_folder.h>
#include <pent/viewer/section.h>

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace pent::viewer {

/// A surface of a body that is shown, with what is needed to paint it.
struct DrawItem {
    Surface surface;
    Positions<3> normals;  ///< 3 x 3 triangles; empty while only its extent is wanted.
    std::size_t body = 0;
    float opacity = 1;
    std::optional<Color> tint;  ///< In place of the body's color.
};

/// Makes the pictures of a run: it knows the bodies, what each tile of a picture shows, and, once
/// it has looked at all frames, the camera and the colors.
template <int Dim>
class RunRenderer {
public:
    RunRenderer(const RunFolder& run, const RenderRunOptions& options);

    /// Takes a frame into account for camera, floor and colors.
    void look_at(int frame);

    /// Settles camera and colors; to be called between look_at() and the pictures.
    void settle();

    /// Pictures a second at which the chosen frames play at their true speed; 30 for one moment.
    [[nodiscard]] double true_rate() const;

    /// Whether no hyperplane has met a body.
    [[nodiscard]] bool is_empty() const { return survey_.box().isEmpty(); }

    [[nodiscard]] ColorRange range() const { return range_; }

    /// How many tiles are side by side in a picture.
    [[nodiscard]] std::size_t tile_count() const { return tiles_.size(); }

    /// One frame, all tiles side by side.
    [[nodiscard]] Image picture(int frame) const;

    /// One frame, a single tile as large as the picture.
    [[nodiscard]] Image tile_picture(int frame, std::size_t tile) const;

    /// One tile of one frame for a contact sheet, smaller than a picture and without a color bar.
    [[nodiscard]] Image small_tile(int frame, std::size_t tile) const;

    /// A strip to put under a contact sheet, with the color bar; without pixels if there is none.
    [[nodiscard]] Image sheet_legend(int width, const Color& paper) const;

private:
    struct Size {
        int width = 0;
        int height = 0;
    };

    [[nodiscard]] std::string longest_caption() const;
    [[nodiscard]] int caption_size(Size size) const;
    [[nodiscard]] CameraFit make_fit(Size size, bool has_bar) const;
    void look_at_obstacles(const Tile& tile, const Snapshot<Dim>& snapshot);
    [[nodiscard]] std::vector<DrawItem> items_in(const Tile& tile,
                                                 const Snapshot<Dim>& snapshot,
                                                 bool with_normals) const;
    [[nodiscard]] DrawItem slice_of(std::size_t body,
                                    const Tile& tile,
                                    std::size_t section,
                                    const Snapshot<Dim>& snapshot,
                                    bool with_normals) const;
    [[nodiscard]] DrawItem outline_of(std::size_t body,
                                      const Tile& tile,
                                      const Snapshot<Dim>& snapshot,
                                      bool with_normals) const;
    [[nodiscard]] Projection projection_of(const Tile& tile) const;
    [[nodiscard]] std::span<const ObstacleShape<Dim>> shown_obstacles(
        const Snapshot<Dim>& snapshot) const;
    void add_items(const Tile& tile,
                   const Snapshot<Dim>& snapshot,
                   std::vector<RenderObject>& objects) const;
    void add_obstacle_ghosts(const Tile& tile,
                             const Snapshot<Dim>& snapshot,
                             const Camera& camera,
                             int height,
                             std::vector<RenderObject>& objects) const;
    [[nodiscard]] Image paint(const Snapshot<Dim>& snapshot,
                              const Tile& tile,
                              const Camera& camera,
                              Size size,
                              bool has_bar) const;
    void write_legend(Image& image, const std::string& line, bool has_bar) const;
    [[nodiscard]] bool has_color_bar() const;
    [[nodiscard]] Size tile_size(std::size_t tile) const;
    [[nodiscard]] Size small_size() const;

    const RunFolder& run_;
    const RenderRunOptions& options_;
    std::vector<Body<Dim>> bodies_;
    Snapshot<Dim> start_;
    std::vector<Section> sections_;
    std::vector<Tile> tiles_;
    std::array<double, 2> times_;  // of the first and the last frame, s
    int time_digits_;              // of captions, behind the point
    Survey survey_;
    Framing framing_;
    ColorRange range_;
    Renderer renderer_;
};

}  // namespace pent::viewer
