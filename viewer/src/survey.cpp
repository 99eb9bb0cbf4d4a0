#include "survey.h"

namespace pent::viewer {

template <int Dim>
Survey survey(const RunFolder& run,
              const std::vector<Body<Dim>>& bodies,
              const std::vector<Section>& sections,
              const std::vector<int>& frames,
              ColorBy color,
              const std::function<void(const Surface&)>& on_surface,
              const std::function<bool()>& go_on) {
    Survey result;
    bool is_first = true;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        for (const Body<Dim>& body : bodies) {
            const Frame<Dim> frame = load_frame<Dim>(run, body, frames[i]);
            const Eigen::VectorXd values = vertex_values<Dim>(body, frame, color);
            for (const Section& section : sections) {
                const Surface surface = take_section<Dim>(body, frame.positions, section);
                if (surface.vertex_count() == 0) {
                    continue;
                }
                if (on_surface) {
                    on_surface(surface);
                }
                result.box.extend(bounding_box(surface));
                const ColorRange range = suitable_range(interpolate(surface, values), color);
                result.range = is_first ? range : joined(result.range, range);
                is_first = false;
            }
        }
        if (go_on && !go_on() && i + 1 < frames.size()) {
            result.is_complete = false;
            break;
        }
    }
    return result;
}

template <int Dim>
std::vector<Section> sections_at_start(const RunFolder& run,
                                       const std::vector<Body<Dim>>& bodies,
                                       const SectionOptions& options) {
    std::vector<Frame<Dim>> start;
    for (const Body<Dim>& body : bodies) {
        start.push_back(load_frame<Dim>(run, body, run.frames.front()));
    }
    return make_sections<Dim>(options, start);
}

template Survey survey<3>(const RunFolder&,
                          const std::vector<Body<3>>&,
                          const std::vector<Section>&,
                          const std::vector<int>&,
                          ColorBy,
                          const std::function<void(const Surface&)>&,
                          const std::function<bool()>&);
template Survey survey<4>(const RunFolder&,
                          const std::vector<Body<4>>&,
                          const std::vector<Section>&,
                          const std::vector<int>&,
                          ColorBy,
                          const std::function<void(const Surface&)>&,
                          const std::function<bool()>&);
template std::vector<Section> sections_at_start<3>(const RunFolder&,
                                                   const std::vector<Body<3>>&,
                                                   const SectionOptions&);
template std::vector<Section> sections_at_start<4>(const RunFolder&,
                                                   const std::vector<Body<4>>&,
                                                   const SectionOptions&);

}  // namespace pent::viewer
