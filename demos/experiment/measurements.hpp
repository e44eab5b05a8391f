// SPDX-License-Identifier: Zlib
#pragma once

// What an experiment measured: rows in named tables, which SQL asks. SQLite keeps them in memory.
//
// Functions that its SQL has beside SQLite's own:
//   percent(part, whole)                  0 of nothing is 0
//   sqrt(x)                               null of nothing
//   interval_low(hits, trials), interval_high(hits, trials)
//                                         the 95 % interval of a share (binomial.hpp); null of nothing
//   interval_low(hits, trials, frames)    the same over frames in which the same objects are met again
//   thousands(n), number(x), fixed(x, digits), ms(x), bytes(n)
//                                         as people read them (format.hpp, data_table.hpp); ms() is of a time in
//                                         any unit; of nothing number() is "-", and the others null
//   median(x), percentile(x, share)       aggregates; null of nothing

#include <demos/report/data_table.hpp>

#include <concepts>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

struct sqlite3;
struct sqlite3_stmt;

namespace hashphase::demos {

template <class Type>
concept Arithmetic = std::integral<Type> || std::floating_point<Type>;

/// A value as it is written where it was measured: any number, a truth (1 or 0), a text, or nothing. A whole number
/// that no double holds, such as a seed of 64 bits, is a text of its digits.
struct Datum {
    // NOLINTBEGIN(google-explicit-constructor): rows are written as lists of values.
    Datum() = default;
    template <Arithmetic Any>
    Datum(Any number) : value(static_cast<double>(number)) {
        if constexpr (std::integral<Any> &&
                      std::numeric_limits<Any>::digits > std::numeric_limits<double>::digits) {
            if (std::cmp_greater(number, kMostExactWhole) ||
                std::cmp_less(number, -kMostExactWhole)) {
                value = std::to_string(number);
            }
        }
    }
    Datum(std::string text) : value(std::move(text)) {}
    Datum(std::string_view text) : value(std::string(text)) {}
    Datum(const char* text) : value(std::string(text)) {}
    Datum(Value any) : value(std::move(any)) {}
    template <class Any>
    Datum(const std::optional<Any>& number) : Datum(number ? Datum(*number) : Datum()) {}
    // NOLINTEND(google-explicit-constructor)

    Value value;
};

/// A row: values under the names of their columns.
using Record = std::vector<std::pair<std::string_view, Datum>>;

class Measurements {
public:
    Measurements();
    Measurements(Measurements&&) noexcept;
    Measurements& operator=(Measurements&&) noexcept;
    ~Measurements();

    /// Makes a table, of which there may then be no row.
    void create(std::string_view table, const std::vector<std::string_view>& columns);

    /// Appends a row to the table and returns its rowid; the first one makes it where there is none, and all
    /// have the same columns in the same order. Throws std::logic_error where they have not.
    std::int64_t add(std::string_view table, const Record& record);

    /// Carries out the first statement of the SQL and takes it off. Its rows, with what it calls its
    /// columns; empty of one that gives none. `parameters` are those that it names, as ":name". Throws
    /// std::logic_error that names the fault.
    DataTable take(std::string_view& sql, const Record& parameters = {});

    /// The same of a single statement.
    DataTable ask(std::string_view sql, const Record& parameters = {}) {
        return take(sql, parameters);
    }

    /// Takes off a statement that is not carried out.
    void skip(std::string_view& sql) { static_cast<void>(prepare(sql)); }

private:
    struct Close {
        void operator()(sqlite3* database) const noexcept;
        void operator()(sqlite3_stmt* statement) const noexcept;
    };
    using Statement = std::unique_ptr<sqlite3_stmt, Close>;
    struct Insertion {
        std::string table;
        std::vector<std::string> columns;
        Statement statement;
    };

    [[nodiscard]] Statement prepare(std::string_view& sql);
    [[nodiscard]] Insertion* find(std::string_view table);

    std::unique_ptr<sqlite3, Close> database_;
    std::vector<Insertion> insertions_;
};

}  // namespace hashphase::demos
