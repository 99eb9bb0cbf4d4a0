#pragma once

#include <pent/viewer/image.h>

#include <filesystem>
#include <memory>

namespace pent::viewer {

/// An MP4 (H.264) movie, made by the program ffmpeg.
///
/// It appears under its name only when finish() is reached.
class Movie {
public:
    /// Whether ffmpeg is there to make one.
    [[nodiscard]] static bool is_possible();

    /// Starts ffmpeg. Throws an Error if it does not start or the file cannot be made.
    ///
    /// @param width, height  Of every picture, pixels, even numbers.
    Movie(const std::filesystem::path& path, int width, int height, double frames_per_second);
    ~Movie();
    Movie(const Movie&) = delete;
    Movie& operator=(const Movie&) = delete;
    Movie(Movie&&) = delete;
    Movie& operator=(Movie&&) = delete;

    /// Throws an Error with what ffmpeg says if it has given up (a full disk).
    void add(const Image& picture);

    /// Ends the movie and gives it its name. Throws an Error as add() does.
    void finish();

private:
    struct Encoder;
    std::unique_ptr<Encoder> encoder_;
};

}  // namespace pent::viewer
