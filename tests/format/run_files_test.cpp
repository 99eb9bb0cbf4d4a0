#include "pent/run_files.h"

#include "pent/error.h"
#include "pent/output_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <support/temp_folder.h>
#include <utility>

namespace pent {
namespace {

// What version 0.1.0 and all later ones wrote, and what the page and Python look for.
TEST(RunFiles, AreWhereEveryReaderLooksForThem) {
    EXPECT_EQ(mesh_file("octopus"), "meshes/octopus.pent");
    EXPECT_EQ(frame_file("octopus", 42), "frames/octopus_000042.pent");
    EXPECT_EQ(frame_file("octopus", 1234567), "frames/octopus_1234567.pent");
    EXPECT_EQ(obstacles_file(42), "obstacles/000042.json");
    EXPECT_EQ(contacts_file(42), "contacts/000042.csv");
    EXPECT_EQ(checkpoint_file(42), "checkpoint/000042.state");
}

TEST(RunFiles, AreAllInOneOfTheParts) {
    for (const std::string& file : {mesh_file("a"), frame_file("a", 0), obstacles_file(0),
                                    contacts_file(0), checkpoint_file(0)}) {
        const std::string folder = file.substr(0, file.find('/'));
        EXPECT_EQ(std::count(kPartsOfRun.begin(), kPartsOfRun.end(), folder), 1) << file;
    }
}

// A list of a folder gives back what was written under the names of a run, and nothing else.
TEST(FramesOfRun, AreThoseThatWereWritten) {
    const test::TempFolder folder;
    std::map<std::string, std::set<int>> written;
    for (const char* body : {"a", "a_1", "a_000001", "_", "b 2"}) {
        make_folder(folder / kMeshesFolder);
        make_folder(folder / kFramesFolder);
        write_text(folder / mesh_file(body), "");
        for (const int frame : {0, 7, 999999, 1000000, 2147483647}) {
            write_text(folder / frame_file(body, frame), "");
            written[body].insert(frame);
        }
    }
    for (const char* name :
         {".a_000002.pent.77.tmp", ".a_000003.pent", "a_notes.pent", "a_00002.pent",
          "a_0000002.pent", "a_-00002.pent", "a_+00002.pent", "a_2147483648.pent", "a_.pent",
          "a_000002.json", "a000002.pent", "a_000002"}) {
        write_text(folder / kFramesFolder / name, "");
    }
    write_text(folder / kMeshesFolder / ".a.pent", "");
    EXPECT_EQ(frames_of_run(folder.path(), "a run"), written);
    EXPECT_EQ(bodies_of_run(folder.path(), "a run"),
              (std::vector<std::string>{"_", "a", "a_000001", "a_1", "b 2"}));
}

TEST(FramesOfRun, SayWhatWasExpectedWhereThereIsNoFolder) {
    const test::TempFolder folder;
    for (const auto& [action, where] :
         {std::pair<std::function<void()>, std::string>{
              [&] { (void)bodies_of_run(folder.path(), "a run"); }, "/meshes: "},
          {[&] { (void)frames_of_run(folder.path(), "a run"); }, "/frames: "}}) {
        try {
            action();
            ADD_FAILURE() << where;
        } catch (const Error& error) {
            const std::string message = error.what();
            EXPECT_NE(message.find(where), std::string::npos) << message;
            EXPECT_NE(message.find("; expected a run"), std::string::npos) << message;
        }
    }
}

}  // namespace
}  // namespace pent
