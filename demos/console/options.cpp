// SPDX-License-Identifier: Zlib
#include <demos/console/options.hpp>

#include <demos/console/format.hpp>
#include <demos/console/result_file.hpp>

#include <charconv>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

namespace hashphase::demos {
namespace {

// What options are called in the help tells, too, what is done with their values.
constexpr const char* kFileToRead = "FILE";
constexpr const char* kFileToWrite = "NEW-FILE";
constexpr const char* kFolderToWrite = "FOLDER";

std::string limitText(std::uint64_t limit) {
    return limit == std::numeric_limits<std::uint64_t>::max() ? "2^64 - 1" : withThousands(limit);
}

// Gives CLI11 the digits that it reads: without separators and exponents, and not as octal.
template <class Read, class IsRight>
CLI::Validator numberValidator(const Read& read, const IsRight& isRight,
                               const std::string& whatItIs, const std::string& help = "") {
    return {[=](std::string& text) {
                const auto number = read(text);
                if (!number || !isRight(*number)) {
                    return quotedWord(text) + " is not " + whatItIs;
                }
                std::array<char, 32> digits{};
                text.assign(
                    digits.data(),
                    std::to_chars(digits.data(), digits.data() + digits.size(), *number).ptr);
                return std::string();
            },
            help};
}

CLI::Validator wholeValidator(const std::string& whatItIs, std::uint64_t least, std::uint64_t most,
                              const std::string& help) {
    return numberValidator(
        wholeNumber, [=](std::uint64_t number) { return number >= least && number <= most; },
        whatItIs + " from " + limitText(least) + " to " + limitText(most), help);
}

CLI::Option* addPath(CLI::App& app, const std::string& name, std::string& path,
                     const std::string& description, const char* type, std::string instead) {
    return app.add_option(name, path, description)
        ->type_name(type)
        ->check([instead = std::move(instead)](const std::string& text) {
            return text == "-" ? "'-' names no file here; " + instead : std::string();
        });
}

// In the words of people, not of C++.
void nameType(CLI::Option& option) {
    const std::string name = option.get_type_name();
    if (name.starts_with("UINT") || name.starts_with("INT")) {
        option.type_name("N");
    } else if (name.starts_with("FLOAT")) {
        option.type_name("NUMBER");
    }
}

bool writes(const CLI::Option& option) {
    return option.get_type_name() == kFileToWrite;
}

// Devices are no files that anything is lost in.
bool isSameFile(const std::filesystem::path& a, const std::filesystem::path& b) {
    std::error_code error;
    if (std::filesystem::exists(a, error) && std::filesystem::exists(b, error)) {
        return std::filesystem::equivalent(a, b, error) &&
               std::filesystem::is_regular_file(a, error);
    }
    return std::filesystem::weakly_canonical(a, error) ==
           std::filesystem::weakly_canonical(b, error);
}

// Of a file whose bytes first go to the other's path.
std::string partialClashOf(const CLI::Option& written, const CLI::Option& other) {
    const auto path = other.as<std::string>();
    if (!writes(written) || !isSameFile(ResultFile::partialOf(written.as<std::string>()), path)) {
        return {};
    }
    return written.get_name() + " would first be written to " + path + ", which " +
           other.get_name() + (writes(other) ? " writes, too." : " reads.");
}

std::string clashOf(const CLI::Option& a, const CLI::Option& b) {
    for (const auto& [written, other] : {std::pair(&a, &b), std::pair(&b, &a)}) {
        if (std::string fault = partialClashOf(*written, *other); !fault.empty()) {
            return fault;
        }
    }
    const auto path = a.as<std::string>();
    if (!(writes(a) || writes(b)) || !isSameFile(path, b.as<std::string>())) {
        return {};
    }
    if (writes(a) && writes(b)) {
        return a.get_name() + " and " + b.get_name() + " would both be written to " + path + ".";
    }
    const bool readsFirst = writes(b);
    return (readsFirst ? b : a).get_name() + " would be written over what " +
           (readsFirst ? a : b).get_name() + " reads: " + path + ".";
}

}  // namespace

CLI::Validator wholeFrom(std::uint64_t least, std::uint64_t most) {
    return wholeValidator("a whole number", least, most,
                          limitText(least) + " to " + limitText(most));
}

CLI::Validator seedUpTo(std::uint64_t most) {
    return wholeValidator("a seed, which is a whole number", 0, most, "");
}

CLI::Validator positiveSeconds() {
    return numberValidator(
        finiteNumber, [](double seconds) { return seconds > 0; }, "a number of seconds above 0");
}

CLI::Validator metresFrom(double least, double most) {
    return numberValidator(
        finiteNumber, [=](double metres) { return metres >= least && metres <= most; },
        "a number of metres from " + plain(least) + " to " + plain(most));
}

CLI::Option* addFileToRead(CLI::App& app, const std::string& name, std::string& path,
                           const std::string& description) {
    return addPath(app, name, path, description, kFileToRead,
                   "nothing is read from the standard input: save it to a file first");
}

CLI::Option* addFileToWrite(CLI::App& app, const std::string& name, std::string& path,
                            const std::string& description) {
    return addPath(app, name, path, description, kFileToWrite, "name one, such as /dev/stdout");
}

CLI::Option* addFolderToWrite(CLI::App& app, const std::string& name, std::string& path,
                              const std::string& description) {
    return addPath(app, name, path, description, kFolderToWrite, "name a folder");
}

void checkValues(CLI::App& app) {
    for (CLI::Option* option : app.get_options()) {
        if (option->get_items_expected_max() == 0) {
            continue;  // a flag
        }
        nameType(*option);
        const bool isList = option->get_delimiter() != '\0';
        // Before all that looks at the value.
        option->transform(CLI::Validator(
            [isList](std::string& text) {
                const std::string_view word = withoutBlanks(text);
                if (word.empty()) {
                    return std::string("the value is empty");
                }
                if (isList) {
                    text = std::string(word);
                }
                return std::string();
            },
            ""));
    }
}

std::string pathClash(const CLI::App& app) {
    const std::vector<const CLI::Option*> files = app.get_options([](const CLI::Option* option) {
        return option->count() > 0 && (writes(*option) || option->get_type_name() == kFileToRead);
    });
    for (std::size_t b = 0; b < files.size(); ++b) {
        for (std::size_t a = 0; a < b; ++a) {
            if (std::string fault = clashOf(*files[a], *files[b]); !fault.empty()) {
                return fault;
            }
        }
    }
    return {};
}

}  // namespace hashphase::demos
