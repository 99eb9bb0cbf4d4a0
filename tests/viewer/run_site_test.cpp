#include "run_site.h"

#include "runs.h"
#include "web_pages.h"

#include <pent/obstacles_file.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <support/messages.h>
#include <support/temp_folder.h>

namespace pent::viewer {
namespace {

namespace fs = std::filesystem;
using pent::test::expect_contains;
using pent::test::TempFolder;

constexpr int kPort = 8080;

class RunSiteOf : public testing::Test {
protected:
    RunSiteOf() {
        test::write_run(folder_ / "my run", "a", {0, 1, 2, 5});
        write_text(folder_ / "secret.pent", "secret");
        write_text(folder_ / "my run" / "notes.txt", "not for others");
        page_ = test::write_page(folder_.path());
    }

    [[nodiscard]] RunSite site() const { return {page_, folder_ / "my run"}; }

    [[nodiscard]] HttpResponse get(const std::string& path) const {
        return site().answer({"GET", path, "127.0.0.1:8080"}, kPort);
    }

    TempFolder folder_;
    fs::path page_;
};

TEST_F(RunSiteOf, ARunGivesThePageItsFilesAndAList) {
    EXPECT_EQ(site().start(), "/?run=my%2520run/");  // the address my%20run/, encoded
    EXPECT_NE(get("/").body.find("viewer"), std::string::npos);
    EXPECT_NE(get("/").headers.find("default-src 'none'"), std::string::npos);
    EXPECT_EQ(get("/my run/run.json").body,
              "{\"meshes\":[\"a\"],\"frames\":{\"a\":[[0,2],[5,5]]},\"obstacles\":\"none\","
              "\"follow\":true}");
    EXPECT_EQ(get("/my run/frames/a_000001.pent").body.substr(0, 4), "ply\n");
    EXPECT_EQ(get("/my run/meshes/a.pent").type, "application/octet-stream");
    EXPECT_EQ(get("/my run/frames/a_000007.pent").status, 404);
}

TEST_F(RunSiteOf, APageGivesItsPlaygroundIfThereIsOne) {
    EXPECT_EQ(get("/playground.js").status, 404);
    write_text(page_.parent_path() / "playground.js", "simulator");
    EXPECT_EQ(get("/playground.js").body, "simulator");
    EXPECT_EQ(get("/playground.js").type, "text/javascript; charset=utf-8");
    EXPECT_NE(get("/").headers.find("'wasm-unsafe-eval'"), std::string::npos);
}

TEST_F(RunSiteOf, ARunGivesItsObstacles) {
    const fs::path run = folder_ / "my run";
    EXPECT_EQ(get("/my run/obstacles.json").status, 404);
    write_obstacles<4>(run / "obstacles.json", {});
    EXPECT_EQ(get("/my run/obstacles.json").type, "application/json");
    EXPECT_NE(get("/my run/run.json").body.find("\"obstacles\":\"still\""), std::string::npos);
    fs::remove(run / "obstacles.json");
    make_folder(run / "obstacles");
    for (const char* name : {"000000.json", "000001.json", ".000002.json.7.tmp", "notes.txt"}) {
        write_text(run / "obstacles" / name, "{}");
    }
    EXPECT_EQ(get("/my run/obstacles/000001.json").body, "{}");
    for (const char* name : {"000007.json", ".000002.json.7.tmp", "notes.txt", "../report.json"}) {
        EXPECT_EQ(get(std::string("/my run/obstacles/") + name).status, 404) << name;
    }
}

// pent-sim writes the obstacles of a frame behind its bodies.
TEST_F(RunSiteOf, ARunListsAFrameThatIsBeingWrittenOnlyWithItsObstacles) {
    const fs::path run = folder_ / "my run";
    make_folder(run / "obstacles");
    write_text(run / "obstacles" / "000000.json", "{}");
    write_text(run / "obstacles" / "000001.json", "{}");
    expect_contains(get("/my run/run.json").body,
                    {"[[0,1]]", "\"obstacles\":\"moving\"", "\"follow\":true"});
    write_text(run / "report.json", "{\n \"verdict\": \"finished\"\n}");
    expect_contains(get("/my run/run.json").body, {"[[0,2],[5,5]]", "\"follow\":false"});
}

TEST_F(RunSiteOf, ARunFollowsItWhileItIsWritten) {
    const RunSite site = this->site();
    const auto get = [&](const std::string& path) {
        return site.answer({"GET", path, "localhost:8080"}, kPort);
    };
    EXPECT_NE(get("/my run/run.json").body.find("\"follow\":true"), std::string::npos);
    const fs::path report = folder_ / "my run" / "report.json";
    write_text(report, "{\n \"created_by\": \"pent-sim\",\n \"verdict\": \"running\"\n}");
    EXPECT_NE(get("/my run/run.json").body.find("\"follow\":true"), std::string::npos);
    test::write_run(folder_ / "my run", "a", {3});
    EXPECT_NE(get("/my run/run.json").body.find("[[0,3],[5,5]]"), std::string::npos);
    write_text(report, "{\n \"created_by\": \"pent-sim\",\n \"verdict\": \"finished\"\n}");
    EXPECT_NE(get("/my run/run.json").body.find("\"follow\":false"), std::string::npos);
    fs::remove_all(folder_ / "my run" / "frames");
    EXPECT_EQ(get("/my run/run.json").status, 404);
}

TEST_F(RunSiteOf, ARunGivesNothingElse) {
    const RunSite site = this->site();
    fs::create_symlink(folder_ / "secret.pent", folder_ / "my run" / "meshes" / "link.pent");
    for (const std::string path :
         {"/my run/../secret.pent", "/my run/meshes/../../secret.pent", "/secret.pent",
          "/my run/meshes/link.pent", "/my run/notes.txt", "/my run/", "/my run/meshes/",
          "/my run/meshes/.pent", "/my run/frames/.a_000001.pent.7.tmp", "//etc/passwd",
          "/my run//etc/passwd", "/my run/frames", "/my run"}) {
        EXPECT_EQ(site.answer({"GET", path, "localhost:8080"}, kPort).status, 404) << path;
    }
}

TEST_F(RunSiteOf, ARunAnswersOnlyWhoeverNamesThisMachineAndAsksWithGet) {
    for (const std::string host : {"", "127.0.0.1", "127.0.0.1:80", "evil.example:8080",
                                   "localhost.evil.example:8080", "[::1]:8080"}) {
        EXPECT_EQ(site().answer({"GET", "/", host}, kPort).status, 403) << host;
    }
    EXPECT_EQ(site().answer({"GET", "/", "localhost:8080"}, kPort).status, 200);
    for (const std::string method : {"POST", "HEAD", "PUT", "DELETE", "get"}) {
        EXPECT_EQ(site().answer({method, "/", "127.0.0.1:8080"}, kPort).status, 405) << method;
    }
}

TEST_F(RunSiteOf, AMeshGivesThatFile) {
    const fs::path mesh = folder_ / "my run" / "meshes" / "a.pent";
    const RunSite site(page_, mesh);
    EXPECT_EQ(site.start(), "/?run=a.pent/");
    const auto get = [&](const std::string& path) {
        return site.answer({"GET", path, "localhost:8080"}, kPort);
    };
    EXPECT_EQ(get("/a.pent/run.json").body, R"({"mesh":"a.pent"})");
    EXPECT_EQ(get("/a.pent/a.pent").body.substr(0, 4), "ply\n");
    for (const char* path : {"/a.pent", "/b.pent/b.pent", "/a.pent/b.pent", "/a.pent/scene.toml"}) {
        EXPECT_EQ(get(path).status, 404) << path;
    }
}

// What a browser does with start(): it takes the address behind run=, and asks for what is there.
TEST_F(RunSiteOf, ARunOrMeshOfAnyNameIsAtTheAddressThatIsSaid) {
    for (const std::string name :
         {"a", "50%", "a%23", "#1", "why?", "a b+c", "ü 4D", "a:b\\c&d=e"}) {
        fs::copy_file(folder_ / "my run/meshes/a.pent", folder_ / name);
        fs::copy(folder_ / "my run", folder_ / (name + " run"), fs::copy_options::recursive);
        const auto asked = [&](const std::string& of, const std::string& file) {
            const RunSite site(page_, folder_ / of);
            const std::string query = site.start().substr(std::string("/?run=").size());
            // Decoded by the reader of parameters, then as the target of a request.
            const std::string address = parse_request("GET /" + query + " HTTP/1.1\r\n\r\n")->path;
            EXPECT_EQ(address.find_first_of("#? +&\\:"), std::string::npos) << address;
            const auto request =
                parse_request("GET " + address + percent_encoded(file) + " HTTP/1.1\r\n\r\n");
            return site.answer({"GET", request->path, "localhost:8080"}, kPort);
        };
        EXPECT_EQ(asked(name, name).body.substr(0, 4), "ply\n") << name;
        EXPECT_EQ(asked(name, "run.json").body, "{\"mesh\":" + json_string(name) + "}");
        EXPECT_EQ(asked(name + " run", "run.json").status, 200) << name;
    }
}

TEST_F(RunSiteOf, AModelOfOtherProgramsGivesThatFileAsItIs) {
    for (const char* name : {"tiger.g4b", "tiger.g4tf", "TIGER.G4B"}) {
        const fs::path model = folder_ / name;
        EXPECT_THROW(RunSite(page_, model), Error);
        write_text(model, "of this it is the page that knows");
        const RunSite site(page_, model);
        const std::string folder = "/" + std::string(name) + "/";
        EXPECT_EQ(site.start(), "/?run=" + folder.substr(1));
        const HttpResponse answer = site.answer({"GET", folder + name, "localhost:80"}, 80);
        EXPECT_EQ(answer.body, "of this it is the page that knows");
    }
}

// What the model names in its folder or below, and nothing else that lies there, or that a link or
// a name leads to.
TEST_F(RunSiteOf, AModelGivesTheFilesOfItsBuffers) {
    const std::string json =
        R"({"buffers":[{"uri":"points.bin"},{"uri":"./parts/a b.bin"},{"byteLength":4},)"
        R"({"uri":"data:application/octet-stream;base64,AAAA"},{"uri":"link.bin"},)"
        R"({"uri":"gone.bin"},)"
        R"({"uri":"../secret.pent"},{"uri":")"
        + (folder_ / "secret.pent").string() + R"("},{"uri":""},{"uri":"parts"}]})";
    const fs::path models = folder_ / "models";
    make_folder(models / "parts");
    write_text(models / "points.bin", "points");
    write_text(models / "other.bin", "not named");
    write_text(models / "parts/a b.bin", "of a part");
    fs::create_symlink(folder_ / "secret.pent", models / "link.bin");
    write_text(models / "cell.g4tf", json);
    // As text in the first chunk: 16 bytes of the file, 16 of the chunk, which may have a "{" in
    // their lengths.
    write_text(models / "cell.g4b", "G4MF" + std::string(12, '{') + "JSON" + std::string(12, '{')
                                        + json + std::string(9, '\0'));
    for (const std::string model : {"cell.g4tf", "cell.g4b"}) {
        const RunSite site(page_, models / model);
        const auto get = [&](const std::string& path) {
            return site.answer({"GET", "/" + model + "/" + path, "localhost:8080"}, kPort);
        };
        EXPECT_EQ(get("points.bin").body, "points") << model;
        EXPECT_EQ(get("points.bin").type, "application/octet-stream");
        EXPECT_EQ(get("parts/a b.bin").body, "of a part") << model;
        for (const std::string& path :
             {std::string("other.bin"), std::string("link.bin"), std::string("gone.bin"),
              std::string("../secret.pent"), (folder_ / "secret.pent").string(), std::string(),
              std::string("parts"), std::string("parts/"), std::string("scene.toml"),
              std::string("cell.g4t")}) {
            EXPECT_EQ(get(path).status, 404) << model << " " << path;
        }
    }
    for (const std::string text : {"", "G4MF", "{", "[]", R"({"buffers":[{"uri":7}]})", "null"}) {
        write_text(models / "bad.g4tf", text);
        const RunSite site(page_, models / "bad.g4tf");
        const HttpRequest request{"GET", "/bad.g4tf/points.bin", "localhost:8080"};
        EXPECT_EQ(site.answer(request, kPort).status, 404) << text;
    }
}

TEST_F(RunSiteOf, WhatIsNoPageIsRefused) {
    using pent::test::error_of;
    const fs::path run = folder_ / "my run";
    expect_contains(
        error_of([&] { RunSite(folder_ / "none.html", run); }),
        {"none.html: cannot be read: No such file", "build the page with scripts/web.sh"});
    expect_contains(error_of([&] { RunSite(folder_ / "secret.pent", run); }),
                    {"secret.pent: is not the page of the viewer"});
}

}  // namespace
}  // namespace pent::viewer
