#include <pent/formatted.h>
#include <pent/mesher/quality.h>

#include <algorithm>
#include <cinttypes>

namespace pent::mesher {

namespace {

// The picture in pixels; bars stand between the margins.
constexpr double kWidth = 640;
constexpr double kHeight = 360;
constexpr double kLeft = 70;
constexpr double kRight = 20;
constexpr double kTop = 50;
constexpr double kBottom = 50;

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            default:
                result += c;
        }
    }
    return result;
}

double bar_left(int bin) {
    return kLeft + (kWidth - kLeft - kRight) * bin / kHistogramBins;
}

double bar_top(double part) {
    return kTop + (kHeight - kTop - kBottom) * (1 - part);
}

}  // namespace

std::string quality_svg(const QualityReport& report, const std::string& title) {
    const std::int64_t most = *std::max_element(report.histogram.begin(), report.histogram.end());
    std::string svg = formatted(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%g\" height=\"%g\" "
        "font-family=\"sans-serif\" font-size=\"13\">\n",
        kWidth, kHeight);
    svg += "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
    svg += formatted("<text x=\"%g\" y=\"22\" font-size=\"15\">%s</text>\n", kLeft,
                     escaped(title).c_str());
    svg += formatted(
        "<text x=\"%g\" y=\"40\" fill=\"#555\">mean ratio: min %.3f, median %.3f, mean "
        "%.3f</text>\n",
        kLeft, report.mean_ratio.min, report.mean_ratio.median, report.mean_ratio.mean);
    for (int bin = 0; bin < kHistogramBins; ++bin) {
        const double part = static_cast<double>(report.histogram[bin]) / static_cast<double>(most);
        svg += formatted(
            "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" "
            "fill=\"#3b6ea5\"/>\n",
            bar_left(bin) + 1, bar_top(part), bar_left(bin + 1) - bar_left(bin) - 2,
            bar_top(0) - bar_top(part));
    }
    svg += formatted("<path d=\"M%g %gH%g\" stroke=\"black\"/>\n", kLeft, bar_top(0),
                     bar_left(kHistogramBins));
    for (int bin = 0; bin <= kHistogramBins; bin += 4) {
        svg += formatted("<text x=\"%.2f\" y=\"%g\" text-anchor=\"middle\">%.1f</text>\n",
                         bar_left(bin), bar_top(0) + 18, bin / static_cast<double>(kHistogramBins));
    }
    svg +=
        formatted("<text x=\"%g\" y=\"%g\" text-anchor=\"middle\">mean ratio (1: regular)</text>\n",
                  (kLeft + kWidth - kRight) / 2, kHeight - 12);
    svg += formatted("<text x=\"%g\" y=\"%g\" text-anchor=\"end\">%" PRId64 "</text>\n", kLeft - 6,
                     bar_top(1) + 5, most);
    svg += formatted("<text x=\"%g\" y=\"%g\" text-anchor=\"end\">cells 0</text>\n", kLeft - 6,
                     bar_top(0) + 4);
    return svg + "</svg>\n";
}

}  // namespace pent::mesher
