#include "common/program.h"
#include "common/values.h"
#include "view_options.h"

#include <pent/child_process.h>
#include <pent/counted.h>
#include <pent/error.h>
#include <pent/viewer/export_page.h>
#include <pent/viewer/run_folder.h>
#include <pent/viewer/run_server.h>

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace pent::apps {

namespace {

struct Arguments {
    std::string input;
    std::string page;
    std::string output;
    std::string frames;
    int port = 0;
    double limit = 64;
    bool is_headless = false;
};

void add_options(CLI::App& cli, Arguments& arguments) {
    cli.add_option(
           "input", arguments.input,
           "Run folder of pent-sim, a .pent mesh, or a model of other programs (.g4b, .g4tf)")
        ->required()
        ->type_name("RUN");
    cli.add_option("--port", arguments.port, "Port on 127.0.0.1; default: any that is free")
        ->check(whole_number(1, 65535));
    cli.add_flag("--no-open", arguments.is_headless, "Say the address; open no browser");
    cli.add_option("--export", arguments.output,
                   "Write one page with the run in it, which opens by a double click, and end")
        ->type_name("PAGE.html");
    cli.add_option("--frames", arguments.frames,
                   "Of --export: a number, A:B or A:B:STEP with B included, last, or several with "
                   "commas; default: all")
        ->type_name("LIST");
    cli.add_option("--limit", arguments.limit, "Of --export: largest size, MB; default: 64")
        ->check(number(0.1, 1e6));
    cli.add_option("--page", arguments.page,
                   "index.html as scripts/web.sh builds it; default: the installed one, or that of "
                   "this source")
        ->type_name("FILE");
}

// The page beside the program as installed, or where this program's source builds it.
std::filesystem::path page_of(const Arguments& arguments) {
    if (!arguments.page.empty()) {
        return arguments.page;
    }
    std::error_code error;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    const std::filesystem::path installed =
        program.parent_path().parent_path() / "share" / "pentimento" / "index.html";
    return std::filesystem::exists(installed, error) ? installed : PENT_WEB_PAGE;
}

bool open_browser(const std::string& address) {
    try {
        ChildProcess("xdg-open", {address}).detach();
        return true;
    } catch (const Error&) {
        return false;
    }
}

Verdict export_run(Program& program, const Arguments& arguments) {
    const viewer::RunFolder run = viewer::open_run(arguments.input);
    viewer::ExportOptions options;
    options.page = page_of(arguments);
    options.frames = viewer::select_frames(run.frames, arguments.frames);
    options.most_bytes = static_cast<std::int64_t>(arguments.limit * 1e6);
    make_folder_for(arguments.output);
    WorkProgress progress(program.common().quiet);
    const viewer::ExportReport report =
        viewer::export_page(run, arguments.output, options, std::ref(progress));
    progress.finish();
    program.report()["output"] = arguments.output;
    program.report()["frames"] = options.frames.size();
    program.report()["bytes"] = report.bytes;
    program.report()["largest_error"] = report.largest_error;
    if (!report.is_complete) {
        program.say("stopped: " + arguments.output + " is not written");
        return Verdict::Stopped;
    }
    std::array<char, 96> text{};
    std::snprintf(text.data(), text.size(), ", %.1f MB; positions are right to %.2g m",
                  static_cast<double>(report.bytes) / 1e6, report.largest_error);
    program.say("finished: " + counted(options.frames.size(), "frame", "frames") + " in "
                + arguments.output + text.data());
    return Verdict::Finished;
}

Verdict serve(Program& program, const Arguments& arguments) {
    if (!arguments.frames.empty()) {
        throw Error("--frames: found without --export; the page shows all frames");
    }
    viewer::RunServer server(page_of(arguments), arguments.input, arguments.port);
    program.report()["address"] = server.address();
    const bool is_opened = !arguments.is_headless && open_browser(server.address());
    program.say((is_opened ? "showing " : "open ") + server.address() + "   (Ctrl-C ends)");
    server.serve(stop_requested);
    program.say("finished");
    return Verdict::Finished;
}

}  // namespace

}  // namespace pent::apps

int main(int argc, char** argv) {
    pent::apps::Program program("pent-view",
                                "Shows a run in the browser: slices to turn and to scrub through.",
                                "pent-view RUN/\n  pent-view RUN/ --export page.html --frames ::2");
    pent::apps::Arguments arguments;
    add_options(program.options(), arguments);
    return program.run(argc, argv, [&] {
        std::vector<pent::apps::NamedFile> inputs = pent::apps::inputs_of(arguments.input);
        inputs.push_back({"--page", arguments.page});
        program.require_apart(inputs, {{"--export", arguments.output}});
        return arguments.output.empty() ? serve(program, arguments)
                                        : export_run(program, arguments);
    });
}
