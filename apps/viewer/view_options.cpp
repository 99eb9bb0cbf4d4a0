#include "view_options.h"

#include "common/values.h"

#include <pent/error.h>
#include <pent/real_text.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <regex>
#include <sstream>
#include <utility>

namespace pent::apps {

namespace fs = std::filesystem;

namespace {

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    std::istringstream stream(text + separator);
    for (std::string part; std::getline(stream, part, separator);) {
        parts.push_back(part);
    }
    return parts;
}

double to_number(const std::string& text, const std::string& what) {
    double number = 0;
    const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
    const char* end = text.data() + text.size();
    const auto [stop, error] = real_from_chars(begin, end, number);
    if (error != std::errc() || stop != end || !std::isfinite(number)) {
        throw Error(what + ": found \"" + text + "\"; expected a number");
    }
    return number;
}

// "0.25", or "A:B:N" for N numbers evenly from A to B.
std::vector<double> to_range(const std::string& text, const std::string& what) {
    const std::vector<std::string> parts = split(text, ':');
    if (parts.size() == 1) {
        return {to_number(text, what)};
    }
    const double count = parts.size() == 3 ? to_number(parts[2], what) : 0;
    if (!(count >= 2) || count > 10000 || count != std::floor(count)) {
        throw Error(what + ": found \"" + text
                    + "\"; expected a number, or A:B:N for N from A to B, N at least 2");
    }
    const double from = to_number(parts[0], what);
    const double to = to_number(parts[1], what);
    std::vector<double> numbers;
    numbers.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < static_cast<int>(count); ++i) {
        numbers.push_back(from + (to - from) * i / (count - 1));
    }
    return numbers;
}

std::vector<double> to_offsets(const std::vector<std::string>& texts, const std::string& what) {
    std::vector<double> offsets;
    for (const std::string& text : texts) {
        for (const std::string& part : split(text, ',')) {
            const std::vector<double> range = to_range(part, what);
            offsets.insert(offsets.end(), range.begin(), range.end());
        }
    }
    return offsets;
}

// "xw:30", or "xw:A:B:N" for N angles evenly from A to B; appends the rotation, and the angles if
// there are several.
void add_rotation(const std::string& text, viewer::SectionOptions& sections) {
    const std::string axes = "xyzw";
    const std::string plane = text.substr(0, 2);
    const bool is_plane = text.size() > 3 && text[2] == ':' && plane[0] != plane[1]
                          && plane.find_first_not_of(axes) == std::string::npos;
    if (!is_plane) {
        throw Error("--rotate: found \"" + text
                    + "\"; expected a plane and degrees, as in xw:30, the plane of two of x y z w");
    }
    if (!sections.last_angles.empty()) {
        throw Error("--rotate: found \"" + text
                    + "\" after a rotation by several angles; only the last may have several");
    }
    std::vector<double> radians = to_range(text.substr(3), "--rotate " + text);
    for (double& angle : radians) {
        angle *= std::numbers::pi / 180;
    }
    sections.rotations.push_back({static_cast<int>(axes.find(plane[0])),
                                  static_cast<int>(axes.find(plane[1])), radians.front()});
    if (radians.size() > 1) {
        sections.last_angles = std::move(radians);
    }
}

}  // namespace

std::vector<NamedFile> inputs_of(const std::string& input) {
    std::vector<NamedFile> inputs = parts_of_run(input, "a part of what is looked at");
    inputs.insert(inputs.begin(), {"what is looked at", input});
    return inputs;
}

NamedFile taken_name(const fs::path& file, const fs::path& folder, const std::string& names) {
    std::error_code error;
    const fs::path real = fs::weakly_canonical(fs::absolute(file, error), error);
    const bool is_taken = !file.empty() && !folder.empty()
                          && is_same_file(real.parent_path(), folder)
                          && std::regex_match(real.filename().string(), std::regex(names));
    return is_taken ? NamedFile{"a file of --output", file} : NamedFile();
}

std::vector<double> to_numbers(const std::string& text, const std::string& what) {
    std::vector<double> numbers;
    for (const std::string& part : split(text, ',')) {
        numbers.push_back(to_number(part, what));
    }
    return numbers;
}

void add_view_options(CLI::App& cli, ViewArguments& arguments) {
    cli.add_option("input", arguments.input, "Run folder of pent-sim, or a .pent mesh")
        ->required()
        ->type_name("RUN");
    cli.add_option("--frames", arguments.frames,
                   "Which frames: a number, A:B or A:B:STEP with B included, last, or several with "
                   "commas; default: all")
        ->type_name("LIST");
    cli.add_option("--w", arguments.w,
                   "Slice at w = C, m; several with commas, or A:B:N for N from A to B; default: "
                   "one through the middle of the bodies")
        ->type_name("C")
        ->allow_extra_args(false);
    cli.add_option("--rotate", arguments.rotations,
                   "Turn the bodies about the origin before slicing, PLANE:DEGREES as in xw:30; "
                   "several apply in the order written; the last may be PLANE:A:B:N for N slices")
        ->type_name("TURN")
        ->allow_extra_args(false);
    cli.add_option("--normal", arguments.normal,
                   "Slice across this direction instead, X,Y,Z,W (made unit)")
        ->type_name("N");
    cli.add_option("--offset", arguments.offsets,
                   "Distance of the slice from the origin along --normal, m; several as for --w")
        ->type_name("D")
        ->allow_extra_args(false);
    cli.add_option("--project", arguments.projection,
                   "Add the outline of the whole bodies, projected from 4D: orthographic or "
                   "perspective")
        ->transform(one_of({"orthographic", "perspective"}))
        ->type_name("KIND");
    cli.add_option("--eye", arguments.eye,
                   "Distance of the eye of a perspective from the slice, m; default: three times "
                   "the reach of the bodies")
        ->type_name("D");
    cli.add_option("--color", arguments.color,
                   "Color by body, w, speed, strain, force (of contact), reaction, "
                   "energy_density, or a quantity of frames or meshes by its name; default: body")
        ->type_name("WHAT");
}

std::optional<viewer::ProjectionOptions> to_projection(const ViewArguments& arguments) {
    if (!arguments.eye.empty() && arguments.projection != "perspective") {
        throw Error("--eye: found without --project perspective; give both or none");
    }
    if (arguments.projection.empty()) {
        return std::nullopt;
    }
    viewer::ProjectionOptions projection;
    projection.is_perspective = arguments.projection == "perspective";
    if (!arguments.eye.empty()) {
        projection.eye_distance = to_number(arguments.eye, "--eye");
    }
    return projection;
}

bool WorkProgress::operator()(std::string_view what, std::int64_t done, std::int64_t total) {
    if (!line_ || what != what_) {
        what_ = what;
        line_ = std::make_unique<Progress>(what_, total, quiet_);
    }
    if (done > 0) {
        line_->update(done);
    }
    return !stop_requested();
}

viewer::SectionOptions to_sections(const ViewArguments& arguments) {
    viewer::SectionOptions sections;
    if (arguments.normal.empty() ? !arguments.offsets.empty() : !arguments.w.empty()) {
        throw Error("slices: --offset goes with --normal, and --w does not; give one pair");
    }
    if (!arguments.normal.empty()) {
        const std::vector<double> n = to_numbers(arguments.normal, "--normal");
        if (n.size() != 4) {
            throw Error("--normal: found " + std::to_string(n.size())
                        + " numbers; expected four, as in 0,0,1,1");
        }
        sections.normal = Eigen::Vector4d(n[0], n[1], n[2], n[3]);
    }
    sections.offsets = to_offsets(arguments.normal.empty() ? arguments.w : arguments.offsets,
                                  arguments.normal.empty() ? "--w" : "--offset");
    for (const std::string& text : arguments.rotations) {
        for (const std::string& turn : split(text, ',')) {
            add_rotation(turn, sections);
        }
    }
    return sections;
}

}  // namespace pent::apps
