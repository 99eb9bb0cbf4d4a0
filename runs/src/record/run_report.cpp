#include "record/run_report.h"

#include "record/json_record.h"

#include <pent/error.h>
#include <pent/read_text.h>

#include <algorithm>

namespace pent::runs {

namespace {

// A visitor of the schema that writes the tables of the docs: one for the keys of a part, and
// behind it one for each of its keys that has keys of its own.
struct TableWriter {
    using Field = simulator::Field;

    std::string& rows;
    std::string& tables_behind;

    void operator()(const Field& field, const double& /*value*/) const { add(field, "number"); }
    void operator()(const Field& field, const std::string& /*text*/) const { add(field, "text"); }
    void operator()(const Field& field, const std::vector<std::string>& /*texts*/) const {
        add(field, "list of texts");
    }
    void operator()(const Field& field, const std::vector<double>& /*numbers*/) const {
        add(field, "list of numbers");
    }
    void operator()(const Field& field, const std::vector<NonRigidity>& /*bodies*/) const {
        add(field, "number for each name");
    }
    void operator()(const Field& field, const simulator::Energies& /*energies*/) const {
        add(field, "number for each name");
    }
    template <std::integral Value>
    void operator()(const Field& field, const Value& /*count*/) const {
        add(field, "count");
    }
    template <typename Value>
    requires std::is_enum_v<Value>
    void operator()(const Field& field, const Value& /*value*/) const {
        std::string words;
        for (const std::string_view word : simulator::words<Value>()) {
            words += (words.empty() ? "`" : ", `") + std::string(word) + "`";
        }
        add(field, words);
    }
    template <typename Part>
    void operator()(const Field& field, const std::vector<Part>& /*parts*/) const {
        add(field, "list");
        add_table(field, "Each of ", Part());
    }
    template <typename Part>
    requires std::is_class_v<Part>
    void operator()(const Field& field, const Part& part) const {
        add(field, "table");
        add_table(field, "", part);
    }

    template <typename Part>
    static std::string table(const std::string& title, const Part& part) {
        std::string rows;
        std::string tables_behind;
        fields(part, TableWriter{rows, tables_behind});
        return "**" + title + "**\n\n| key | value | |\n| --- | --- | --- |\n" + rows
               + tables_behind;
    }

private:
    void add(const Field& field, const std::string& kind) const {
        const std::string unit = field.unit.empty() ? "" : ", " + std::string(field.unit);
        rows += "| `" + std::string(field.key) + "` | " + kind + unit + " | "
                + std::string(field.says) + " |\n";
    }
    template <typename Part>
    void add_table(const Field& field, const std::string& before, const Part& part) const {
        tables_behind += "\n" + table(before + "`" + std::string(field.key) + "`", part);
    }
};

// A visitor of the schema that writes a report as Json::dump(1) does, long lists entry by entry:
// as JSON all of them at once take several times the memory of their text.
struct TextWriter {
    using Field = simulator::Field;

    std::string& text;

    template <typename Value>
    void operator()(const Field& field, const Value& value) const {
        Json entry = Json::object();
        RecordWriter{entry}(field, value);
        if (!entry.empty()) {
            begin(field);
            add(entry.front(), 1);
        }
    }
    void operator()(const Field& field, const std::vector<FrameReport>& frames) const {
        add_list(field, frames);
    }
    void operator()(const Field& field, const std::vector<simulator::StepReport>& steps) const {
        add_list(field, steps);
    }

private:
    template <typename Part>
    void add_list(const Field& field, const std::vector<Part>& parts) const {
        begin(field);
        const char* before = "[\n  ";
        for (const Part& part : parts) {
            text += before;
            add(write_record(part), 2);
            before = ",\n  ";
        }
        text += parts.empty() ? "[]" : "\n ]";
    }
    void begin(const Field& field) const {
        text += text.empty() ? "{\n \"" : ",\n \"";
        text.append(field.key).append("\": ");
    }
    // Within a text the end of a line is written as \n.
    void add(const Json& json, std::size_t depth) const {
        // Messages name files, whose names may have bytes that are not UTF-8.
        for (const char c : json.dump(1, ' ', false, Json::error_handler_t::replace)) {
            text += c;
            text.append(c == '\n' ? depth : 0, ' ');
        }
    }
};

}  // namespace

std::string report_text(const RunReport& report) {
    std::string text;
    fields(report, TextWriter{text});
    text += "\n}\n";
    return text;
}

RunReport read_report(const std::filesystem::path& path) {
    const std::string text = read_text(path, "the report of a run");
    try {
        const Json json = Json::parse(text);
        RunReport report;
        report.parts.resize(1);
        fields(report, RecordReader{json});
        if (!json.contains("parts")) {  // of version 0.1.0
            RunPart& part = report.parts.back();
            part.last_frame = report.frames.empty() ? 0 : report.frames.back().frame;
            part.seconds = report.seconds;
            part.verdict = report.verdict;
        }
        return report;
    } catch (const std::exception& error) {
        throw Error(path.string() + ": not the report of a run (" + error.what() + ")");
    }
}

double report_pause(double seconds) {
    return std::max(10.0, 99 * seconds);
}

std::string_view verdict_name(RunVerdict verdict) {
    return simulator::word_of(verdict);
}

std::string report_schema_text() {
    RunReport report;
    report.parts.resize(1);
    return TableWriter::table("`report.json`", report);
}

}  // namespace pent::runs
