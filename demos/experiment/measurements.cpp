// SPDX-License-Identifier: Zlib
#include <demos/experiment/measurements.hpp>

#include <demos/accuracy/binomial.hpp>
#include <demos/console/format.hpp>
#include <demos/report/statistics.hpp>

#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>

#include <sqlite3.h>

namespace hashphase::demos {
namespace {

using Context = sqlite3_context*;
using Arguments = sqlite3_value**;

[[noreturn]] void refuse(sqlite3* database, std::string_view sql) {
    constexpr std::size_t kShown = 300;  // letters: enough to know which statement it is
    throw std::logic_error(std::string(sqlite3_errmsg(database)) +
                           " in: " + std::string(sql.substr(0, kShown)));
}

double numberAt(Arguments arguments, int i) {
    return sqlite3_value_double(arguments[i]);
}

std::uint64_t countAt(Arguments arguments, int i) {
    return static_cast<std::uint64_t>(sqlite3_value_int64(arguments[i]));
}

bool isNull(sqlite3_value* value) {
    return sqlite3_value_type(value) == SQLITE_NULL;
}

void giveText(Context context, const std::string& text) {
    sqlite3_result_text(context, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT);
}

// --- Functions of the SQL -------------------------------------------------------------------------

void percent(Context context, int /*count*/, Arguments arguments) {
    const double whole = numberAt(arguments, 1);
    sqlite3_result_double(context, whole == 0 ? 0 : 100 * numberAt(arguments, 0) / whole);
}

// Not every SQLite has one.
void squareRoot(Context context, int /*count*/, Arguments arguments) {
    if (!isNull(arguments[0])) {
        sqlite3_result_double(context, std::sqrt(numberAt(arguments, 0)));
    }
}

template <double ShareInterval::*bound>
void interval(Context context, int count, Arguments arguments) {
    const std::uint64_t hits = countAt(arguments, 0);
    const std::uint64_t trials = countAt(arguments, 1);
    if (trials == 0) {
        return;  // null
    }
    const ShareInterval share =
        count == 2 ? wilsonInterval(hits, trials)
                   : intervalOverFrames(hits, trials, sqlite3_value_int(arguments[2]));
    sqlite3_result_double(context, share.*bound);
}

void number(Context context, int /*count*/, Arguments arguments) {
    giveText(context, isNull(arguments[0]) ? "-" : valueText(numberAt(arguments, 0)));
}

/// What textOf(arguments) says; null where the first of them is.
template <auto textOf>
void told(Context context, int /*count*/, Arguments arguments) {
    if (!isNull(arguments[0])) {
        giveText(context, textOf(arguments));
    }
}

// The series of an aggregate, which SQLite holds as zeros at first.
struct Series {
    std::vector<double>* numbers;
    double share;
};

void stepOfPercentile(Context context, int count, Arguments arguments) {
    auto* series = static_cast<Series*>(sqlite3_aggregate_context(context, sizeof(Series)));
    if (series == nullptr) {
        return sqlite3_result_error_nomem(context);
    }
    if (series->numbers == nullptr) {
        series->numbers = new (std::nothrow) std::vector<double>;
        series->share = count == 2 ? numberAt(arguments, 1) : 0.5;
    }
    if (series->numbers != nullptr && !isNull(arguments[0])) {
        series->numbers->push_back(numberAt(arguments, 0));
    }
}

void endOfPercentile(Context context) {
    auto* series = static_cast<Series*>(sqlite3_aggregate_context(context, 0));
    if (series == nullptr || series->numbers == nullptr) {
        return;  // null
    }
    const std::unique_ptr<std::vector<double>> numbers(series->numbers);
    if (!numbers->empty()) {
        std::sort(numbers->begin(), numbers->end());
        sqlite3_result_double(context, percentile(*numbers, series->share));
    }
}

struct Function {
    const char* name;
    int arguments;
    void (*call)(Context, int, Arguments);
};

constexpr Function kFunctions[] = {
    {"percent", 2, percent},
    {"sqrt", 1, squareRoot},
    {"interval_low", 2, interval<&ShareInterval::low>},
    {"interval_low", 3, interval<&ShareInterval::low>},
    {"interval_high", 2, interval<&ShareInterval::high>},
    {"interval_high", 3, interval<&ShareInterval::high>},
    {"number", 1, number},
    {"thousands", 1, told<[](Arguments all) { return withThousands(countAt(all, 0)); }>},
    {"fixed", 2,
     told<[](Arguments all) { return fixed(numberAt(all, 0), sqlite3_value_int(all[1])); }>},
    {"ms", 1, told<[](Arguments all) { return milliseconds(numberAt(all, 0)); }>},
    {"bytes", 1, told<[](Arguments all) { return byteSize(sqlite3_value_int64(all[0])); }>},
};
constexpr Function kAggregates[] = {{"median", 1, stepOfPercentile},
                                    {"percentile", 2, stepOfPercentile}};

// --- Values ---------------------------------------------------------------------------------------

void bind(sqlite3_stmt* statement, int place, const Value& value) {
    if (const double* number = std::get_if<double>(&value); number != nullptr) {
        // What is whole is told as such, so that texts made of it have no ".0".
        const bool isWhole = std::abs(*number) <= static_cast<double>(kMostExactWhole) &&
                             std::trunc(*number) == *number;
        isWhole ? sqlite3_bind_int64(statement, place, static_cast<sqlite3_int64>(*number))
                : sqlite3_bind_double(statement, place, *number);
    } else if (const auto* text = std::get_if<std::string>(&value); text != nullptr) {
        sqlite3_bind_text(statement, place, text->data(), static_cast<int>(text->size()),
                          SQLITE_TRANSIENT);
    } else {
        sqlite3_bind_null(statement, place);
    }
}

Value valueIn(sqlite3_stmt* statement, int column) {
    switch (sqlite3_column_type(statement, column)) {
        case SQLITE_NULL:
            return {};
        case SQLITE_TEXT:
            return std::string(
                reinterpret_cast<const char*>(sqlite3_column_text(statement, column)));
        default:
            return sqlite3_column_double(statement, column);
    }
}

std::string quoted(std::string_view name) {
    return '"' + std::string(name) + '"';
}

}  // namespace

void Measurements::Close::operator()(sqlite3* database) const noexcept {
    sqlite3_close(database);
}

void Measurements::Close::operator()(sqlite3_stmt* statement) const noexcept {
    sqlite3_finalize(statement);
}

Measurements::Measurements() {
    sqlite3* database = nullptr;
    const int opened = sqlite3_open(":memory:", &database);
    database_.reset(database);
    if (opened != SQLITE_OK) {
        throw std::bad_alloc();
    }
    constexpr int kPure = SQLITE_UTF8 | SQLITE_DETERMINISTIC;
    for (const auto& [name, arguments, call] : kFunctions) {
        sqlite3_create_function(database, name, arguments, kPure, nullptr, call, nullptr, nullptr);
    }
    for (const auto& [name, arguments, step] : kAggregates) {
        sqlite3_create_function(database, name, arguments, kPure, nullptr, nullptr, step,
                                endOfPercentile);
    }
}

Measurements::Measurements(Measurements&&) noexcept = default;
Measurements& Measurements::operator=(Measurements&&) noexcept = default;
Measurements::~Measurements() = default;

Measurements::Statement Measurements::prepare(std::string_view& sql) {
    sqlite3_stmt* statement = nullptr;
    const char* rest = nullptr;
    if (sqlite3_prepare_v2(database_.get(), sql.data(), static_cast<int>(sql.size()), &statement,
                           &rest) != SQLITE_OK) {
        refuse(database_.get(), sql);
    }
    sql.remove_prefix(static_cast<std::size_t>(rest - sql.data()));
    return Statement(statement);
}

Measurements::Insertion* Measurements::find(std::string_view table) {
    const auto known = std::find_if(insertions_.begin(), insertions_.end(),
                                    [&](const Insertion& each) { return each.table == table; });
    return known != insertions_.end() ? &*known : nullptr;
}

void Measurements::create(std::string_view table, const std::vector<std::string_view>& columns) {
    std::string names;
    std::string marks;
    for (const std::string_view column : columns) {
        names += (names.empty() ? "" : ", ") + quoted(column);
        marks += marks.empty() ? "?" : ", ?";
    }
    ask("CREATE TABLE " + quoted(table) + " (" + names + ")");
    const std::string insert = "INSERT INTO " + quoted(table) + " VALUES (" + marks + ")";
    std::string_view sql = insert;
    insertions_.push_back({std::string(table), {columns.begin(), columns.end()}, prepare(sql)});
}

std::int64_t Measurements::add(std::string_view table, const Record& record) {
    if (find(table) == nullptr) {
        std::vector<std::string_view> columns;
        for (const auto& [name, datum] : record) {
            columns.push_back(name);
        }
        create(table, columns);
    }
    const Insertion& insertion = *find(table);
    const auto isSame = [](const auto& named, const std::string& column) {
        return named.first == column;
    };
    if (!std::equal(record.begin(), record.end(), insertion.columns.begin(),
                    insertion.columns.end(), isSame)) {
        throw std::logic_error("The rows of '" + std::string(table) +
                               "' have not all the same columns.");
    }
    sqlite3_stmt* statement = insertion.statement.get();
    int place = 0;
    for (const auto& [name, datum] : record) {
        bind(statement, ++place, datum.value);
    }
    const int done = sqlite3_step(statement);
    sqlite3_reset(statement);
    if (done != SQLITE_DONE) {
        refuse(database_.get(), table);
    }
    return sqlite3_last_insert_rowid(database_.get());
}

DataTable Measurements::take(std::string_view& sql, const Record& parameters) {
    const std::string_view whole = sql;
    const Statement statement = prepare(sql);
    DataTable found;
    if (!statement) {
        return found;  // a comment, or nothing
    }
    for (const auto& [name, cell] : parameters) {
        const int place =
            sqlite3_bind_parameter_index(statement.get(), (":" + std::string(name)).c_str());
        if (place != 0) {
            bind(statement.get(), place, cell.value);
        }
    }
    const int count = sqlite3_column_count(statement.get());
    for (int i = 0; i < count; ++i) {
        found.columns.push_back({sqlite3_column_name(statement.get(), i)});
    }
    int state = sqlite3_step(statement.get());
    for (; state == SQLITE_ROW; state = sqlite3_step(statement.get())) {
        std::vector<Value>& row = found.rows.emplace_back();
        for (int i = 0; i < count; ++i) {
            row.push_back(valueIn(statement.get(), i));
        }
    }
    if (state != SQLITE_DONE) {
        refuse(database_.get(), whole.substr(0, whole.size() - sql.size()));
    }
    return found;
}

}  // namespace hashphase::demos
