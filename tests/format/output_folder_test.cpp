#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/output_folder.h>

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

namespace pent {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using test::expect_contains;

class OutputFolders : public testing::Test {
protected:
    void put(const std::string& name, const std::string& text = "mine") const {
        fs::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name) << text;
    }
    [[nodiscard]] std::string text_of(const std::string& name) const {
        std::ifstream file(folder_ / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    [[nodiscard]] bool has(const std::string& name) const { return fs::exists(folder_ / name); }

    test::TempFolder folder_;
    fs::path out_ = folder_ / "out";
};

TEST_F(OutputFolders, AreMadeWithTheFirstFileAndListIt) {
    OutputFolder output(out_, "run");
    EXPECT_FALSE(output.has_list());
    EXPECT_FALSE(has("out"));
    EXPECT_EQ(output.claim("frames/a.pent"), out_ / "frames/a.pent");
    EXPECT_TRUE(has("out/frames"));
    expect_contains(text_of("out/written.txt"), {"# pent run: ", "\nframes/a.pent\n"});
    EXPECT_TRUE(OutputFolder(out_, "run").has_list());
}

TEST_F(OutputFolders, OfSomebodyElseAreForeignUnlessEmpty) {
    fs::create_directory(out_);
    EXPECT_FALSE(OutputFolder(out_, "run").is_foreign());
    put("out/.written.txt.4711.tmp");  // of a program killed before it had begun
    EXPECT_FALSE(OutputFolder(out_, "run").is_foreign());
    put("out/notes.txt");
    const OutputFolder foreign(out_, "run");
    EXPECT_TRUE(foreign.is_foreign());
    expect_contains(error_of([&] { foreign.refuse_foreign(); }), {out_.string(), "stays as it is"});
    fs::remove(out_ / "notes.txt");
    put("out/written.txt", "a list of what I wrote\nnotes.txt\n");  // a name that anybody may use
    EXPECT_TRUE(OutputFolder(out_, "run").is_foreign());
}

TEST_F(OutputFolders, AreNotFilesAndNotOfAnotherKind) {
    put("file");
    expect_contains(error_of([&] { OutputFolder(folder_ / "file", "run"); }),
                    {"file: is a file; expected a folder"});
    OutputFolder(out_, "study").adopt("scene.toml");
    expect_contains(error_of([&] { OutputFolder(out_, "run"); }),
                    {"is the folder of a study, not of a run"});
}

TEST_F(OutputFolders, NeverGiveTheNameOfAFileThatIsNotListed) {
    OutputFolder output(out_, "run");
    static_cast<void>(output.claim("a"));
    put("out/b");
    fs::create_symlink("nowhere", out_ / "c");
    for (const std::string name : {"b", "c"}) {
        expect_contains(error_of([&] { static_cast<void>(output.claim(name)); }),
                        {(out_ / name).string(), "was not written by the run"});
    }
    put("out/a");
    EXPECT_EQ(output.claim("a"), out_ / "a");
}

TEST_F(OutputFolders, AreClearedOfWhatIsListedAndOfNothingElse) {
    OutputFolder output(out_, "run");
    for (const char* name : {"scene.toml", "frames/a_0.pent", "meshes/a.pent", "gone.csv"}) {
        put(fs::proximate(output.claim(name), folder_.path()).string(), "ours");
    }
    fs::remove(out_ / "gone.csv");
    for (const char* name : {"out/notes.txt", "out/meshes/torus.pent", "out/frames/sub/x.pent"}) {
        put(name);
    }
    output.clear({});
    EXPECT_FALSE(has("out/scene.toml"));
    EXPECT_FALSE(has("out/frames/a_0.pent"));
    EXPECT_FALSE(has("out/meshes/a.pent"));
    for (const char* name : {"out/notes.txt", "out/meshes/torus.pent", "out/frames/sub/x.pent"}) {
        EXPECT_EQ(text_of(name), "mine") << name;
    }
    output = OutputFolder(out_, "run");
    EXPECT_TRUE(output.has_list());  // still ours to write to
    EXPECT_NO_THROW(static_cast<void>(output.claim("scene.toml")));
}

TEST_F(OutputFolders, AreWrittenToByOneProgramAtATime) {
    auto first = std::make_unique<OutputFolder>(out_, "run");
    static_cast<void>(first->claim("a"));
    OutputFolder second(out_, "run");  // looking is allowed
    EXPECT_TRUE(second.has_list());
    const auto claim = [&] { static_cast<void>(second.claim("b")); };
    const std::string list = text_of("out/written.txt");
    for (int i = 0; i < 2; ++i) {
        expect_contains(error_of(claim),
                        {out_.string() + ": another program is writing to this folder"});
        expect_contains(error_of([&] { second.clear({}); }), {"another program is writing"});
    }
    EXPECT_EQ(text_of("out/written.txt"), list);
    first.reset();
    EXPECT_NO_THROW(claim());
    expect_contains(text_of("out/written.txt"), {"\na\n", "\nb\n"});
}

TEST_F(OutputFolders, AreSharedByProgramsThatWriteToFilesThatAreListed) {
    static_cast<void>(OutputFolder(out_, "run").claim("a"));
    auto first = std::make_unique<OutputFolder>(out_, "run");
    auto second = std::make_unique<OutputFolder>(out_, "run");
    first->share();
    second->share();
    put("out/a", "ours");
    EXPECT_EQ(second->claim("a"), out_ / "a");
    expect_contains(error_of([&] { static_cast<void>(second->claim("b")); }),
                    {"written.txt: does not list b"});
    first->remove("a");
    EXPECT_FALSE(has("out/a"));
    OutputFolder third(out_, "run");
    expect_contains(error_of([&] { static_cast<void>(third.claim("a")); }),
                    {"another program is writing to this folder"});
    first.reset();
    second.reset();
    EXPECT_NO_THROW(static_cast<void>(third.claim("b")));
    OutputFolder fourth(out_, "run");
    expect_contains(error_of([&] { fourth.share(); }), {"another program is writing"});
}

// What another has written between a look and the first change would be lost from the list.
TEST_F(OutputFolders, AreNotWrittenToAfterALookThatIsTooOld) {
    OutputFolder output(out_, "run");
    static_cast<void>(OutputFolder(out_, "run").claim("a"));
    expect_contains(error_of([&] { static_cast<void>(output.claim("b")); }),
                    {"another program has just written to this folder"});
}

// Programs that are started while a folder is locked do not keep it locked when they live longer.
TEST_F(OutputFolders, AreNotLockedByProgramsThatWereStartedMeanwhile) {
    FILE* child = nullptr;
    {
        OutputFolder output(out_, "run");
        static_cast<void>(output.claim("a"));
        child = popen("cat", "w");  // lives until its input ends
        ASSERT_NE(child, nullptr);
    }
    OutputFolder output(out_, "run");
    EXPECT_NO_THROW(static_cast<void>(output.claim("b")));
    pclose(child);
}

TEST_F(OutputFolders, KeepTheirFoldersWithAListOfTheirOwnApart) {
    OutputFolder study(out_, "study");
    const fs::path inner = study.claim("runs/fine/");
    OutputFolder(inner, "run").claim("frames/a.pent");
    put("out/runs/fine/frames/a.pent", "ours");
    const fs::path other = study.claim("runs/with-notes/");
    OutputFolder(other, "run").claim("scene.toml");
    put("out/runs/with-notes/notes.txt");
    study.remove("runs/fine/");
    EXPECT_FALSE(has("out/runs/fine"));
    study.clear({});
    EXPECT_EQ(text_of("out/runs/with-notes/notes.txt"), "mine");
    EXPECT_NO_THROW(static_cast<void>(study.claim("runs/with-notes/")));  // still ours to write to
    put("out/runs/fine/notes.txt");
    EXPECT_THROW(static_cast<void>(study.claim("runs/fine/")), Error);
}

TEST_F(OutputFolders, AreNotClearedOfWhatIsRead) {
    OutputFolder output(out_, "run");
    put(fs::proximate(output.claim("a"), folder_.path()).string(), "ours");
    put(fs::proximate(output.claim("meshes/b.pent"), folder_.path()).string(), "ours");
    fs::create_symlink(out_ / "meshes/b.pent", folder_ / "link.pent");
    for (const fs::path& input : {out_ / "meshes/../meshes/b.pent", folder_ / "link.pent"}) {
        expect_contains(error_of([&] {
                            output.clear({folder_ / "none", input});
                        }),
                        {input.string(), "is read"});
    }
    EXPECT_TRUE(has("out/a"));  // nothing was removed before
    OutputFolder study(folder_ / "study", "study");
    OutputFolder(study.claim("runs/fine/"), "run").claim("meshes/b.pent");
    put("study/runs/fine/meshes/b.pent", "ours");
    EXPECT_THROW(study.clear({folder_ / "study/runs/fine/meshes/b.pent"}), Error);
}

// A list is a file: what is edited into it must not lead anywhere else.
TEST_F(OutputFolders, RefuseNamesThatLeadOutOfThem) {
    put("precious");
    const std::vector<std::string> names = {"../precious", "a/../../precious",
                                            (folder_ / "precious").string()};
    for (const std::string& name : names) {
        put("out/written.txt", "# pent run: x\n" + name + "\n");
        expect_contains(error_of([&] { OutputFolder(out_, "run"); }), {name, "within the folder"});
    }
    EXPECT_EQ(text_of("precious"), "mine");
}

// To the file system such a name ends at its zero byte: "ours" would be removed, or the folder
// read as a list.
TEST_F(OutputFolders, RefuseNamesWithAZeroByte) {
    put("out/ours");
    using namespace std::string_literals;
    for (const std::string& name : {"ours\0x"s, "\0/fine/"s}) {
        put("out/written.txt", "# pent run: x\n" + name + "\n");
        expect_contains(error_of([&] { OutputFolder(out_, "run").clear({}); }),
                        {"within the folder; put the list right"});
    }
    EXPECT_EQ(text_of("out/ours"), "mine");
}

TEST_F(OutputFolders, TakeAFolderInThePlaceOfTheListForSomebodyElses) {
    fs::create_directories(out_ / "written.txt");
    const OutputFolder output(out_, "run");
    EXPECT_FALSE(output.has_list());
    EXPECT_TRUE(output.is_foreign());
}

TEST_F(OutputFolders, ForgetHalfALineThatAKillLeft) {
    OutputFolder(out_, "run").adopt("a");
    std::ofstream(out_ / "written.txt", std::ios::app) << "not";
    put("out/not");
    OutputFolder output(out_, "run");
    output.adopt("b");
    EXPECT_EQ(text_of("out/written.txt").substr(text_of("out/written.txt").find('\n')), "\na\nb\n");
    output.clear({});
    EXPECT_EQ(text_of("out/not"), "mine");
}

TEST_F(OutputFolders, LoseWhatAKilledProgramLeftHalfWrittenAndNoOtherHiddenFile) {
    OutputFolder output(out_, "run");
    static_cast<void>(output.claim("frames/a.pent"));
    static_cast<void>(output.claim("frames/4711"));
    const char* half[] = {"out/frames/.a.pent.4711.tmp", "out/.written.txt.4711.tmp"};
    const char* others[] = {"out/frames/.mine.tmp",     "out/frames/.b.pent.4711.tmp",
                            "out/frames/.a.pent.x.tmp", "out/frames/.a.pent..tmp",
                            "out/frames/.4711.tmp",     "out/.a.pent.4711.tmp"};
    for (const char* name : half) {
        put(name);
    }
    for (const char* name : others) {
        put(name);
    }
    output.remove_temporaries();
    for (const char* name : half) {
        EXPECT_FALSE(has(name)) << name;
    }
    for (const char* name : others) {
        EXPECT_TRUE(has(name)) << name;
    }
}

TEST_F(OutputFolders, LeaveAFolderInThePlaceOfAListedFileAlone) {
    OutputFolder output(out_, "run");
    static_cast<void>(output.claim("a"));
    put("out/a/mine");
    output.clear({});
    EXPECT_TRUE(has("out/a/mine"));
}

}  // namespace
}  // namespace pent
