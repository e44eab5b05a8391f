// SPDX-License-Identifier: Zlib
#include <demos/scenes/effects_file.hpp>

#include <demos/console/format.hpp>
#include <demos/scenes/effects_fields.hpp>
#include <demos/scenes/file_bytes.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/scenes/json_tree.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>
#include <vector>

namespace hashphase::demos {
namespace {

using Kind = JsonValue::Kind;

bool hasNoBound(const JsonValue& value) {
    return value.kind == Kind::text && value.text == kNoBound;
}

/// Each returns false when the value is not what the field must be.
bool assign(const ObjectField& field, const JsonValue& value, EffectsFile& file) {
    if (field.effect && (value.kind == Kind::object || value.truth)) {
        file.effects.declare(*field.effect);
    }
    return value.kind == Kind::object || (field.effect && value.kind == Kind::boolean);
}

bool assign(const TextField& field, const JsonValue& value, EffectsFile& file) {
    field.place(file) = value.text;
    return value.kind == Kind::text;
}

bool assign(const NumberField& field, const JsonValue& value, EffectsFile& file) {
    const bool isOpen = hasNoBound(value) && field.most == NumberField::kInfinite;
    const double number = isOpen ? NumberField::kInfinite : value.number;
    const bool isRight = (isOpen || value.kind == Kind::number) && number >= field.least &&
                         number <= field.most && (!field.isWhole || number == std::trunc(number));
    if (isRight) {
        field.access.set(file, number);
    }
    return isRight;
}

bool assign(const ChoiceField& field, const JsonValue& value, EffectsFile& file) {
    const auto found = std::ranges::find(field.choices, value.text, &NamedValue::name);
    const bool isRight = value.kind == Kind::text && found != field.choices.end();
    if (isRight) {
        field.access.set(file, found->value);
    }
    return isRight;
}

bool assign(const CornerField& field, const JsonValue& value, EffectsFile& file) {
    if (value.kind != Kind::array || value.members.size() != 3) {
        return false;
    }
    Vector3<double>& corner = field.place(file);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const JsonValue& element = value.members[static_cast<std::size_t>(axis)];
        if (element.kind != Kind::number && !hasNoBound(element)) {
            return false;
        }
        corner[axis] = hasNoBound(element) ? field.noBound : element.number;
    }
    return true;
}

/// What it is, an array with its elements.
std::string found(const JsonValue& value) {
    if (value.kind != Kind::array || value.members.empty() || value.members.size() > 4) {
        return describe(value);
    }
    std::vector<std::string> elements;
    for (const JsonValue& element : value.members) {
        elements.push_back(describe(element));
    }
    return "[" + joined(elements, ", ") + "]";
}

/// What fields that are right for themselves have against each other; begins with a path.
std::string contradictionIn(const EffectsFile& file) {
    const EffectsScene& scene = file.scene;
    if (2 * scene.radius > scene.domain) {
        std::ostringstream sentence;
        sentence << "scene.radius is " << scene.radius
                 << ", but a body must fit into scene.domain, which is " << scene.domain << " [m].";
        return sentence.str();
    }
    const std::string error = effectsError(file.effects);
    const std::string_view ofGrid = "GridConfig::";
    if (error.rfind(ofGrid, 0) == 0) {
        return "grid." + error.substr(ofGrid.size());
    }
    return error.empty() ? error : "effects." + error;
}

class FileReader {
public:
    FileReader(const JsonValue& root, const std::string& name) : root_(root), name_(name) {}

    [[nodiscard]] EffectsFile read() {
        if (root_.kind != Kind::object) {
            fail(root_, "the file holds " + describe(root_) + ", but must hold an object.");
        }
        readMembers(root_, "");
        const std::string error = contradictionIn(file_);
        if (!error.empty()) {
            failWith(error);
        }
        return std::move(file_);
    }

private:
    void readMembers(const JsonValue& object, const std::string& section) {
        for (const JsonValue& member : object.members) {
            const EffectsField& field = fieldOf(member, section);
            const std::string path = pathOf(section, field.name);
            const bool isRight = std::visit(
                [&](const auto& kind) { return assign(kind, member, file_); }, field.kind);
            if (!isRight) {
                fail(member,
                     path + " is " + found(member) + ", but must be " + requirementOf(field) + ".");
            }
            if (member.kind == Kind::object) {
                readMembers(member, path);
            }
        }
    }

    [[nodiscard]] const EffectsField& fieldOf(const JsonValue& member,
                                              const std::string& section) const {
        std::vector<std::string> names;
        for (const EffectsField& field : effectsFields()) {
            if (field.section == section) {
                if (field.name == member.name) {
                    return field;
                }
                names.emplace_back(field.name);
            }
        }
        const std::string unknown = printable(member.name);
        const std::string what = section == "effects" ? "effect" : "field";
        fail(member, pathOf(section, unknown) + ": there is no such " + what +
                         (names.empty() ? "; " + section + " has no settings."
                                        : suggestion(unknown, names, "")));
    }

    /// Fails with the sentence, which begins with a path, at the innermost value on it that there is.
    [[noreturn]] void failWith(const std::string& sentence) const {
        const JsonValue* value = &root_;
        std::istringstream path(sentence.substr(0, sentence.find_first_of(" :")));
        for (std::string name; std::getline(path, name, '.');) {
            const JsonValue* const member = value->find(name);
            if (member == nullptr) {
                break;
            }
            value = member;
        }
        fail(*value, sentence);
    }

    [[noreturn]] void fail(const JsonValue& value, const std::string& sentence) const {
        throw InputError(name_ + ":" + std::to_string(value.line) + ": " + sentence);
    }

    const JsonValue& root_;
    const std::string& name_;
    EffectsFile file_;
};

}  // namespace

EffectsFile parseEffectsFile(std::string_view text, const std::string& name) {
    if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) {
        throw InputError(name +
                         " is empty; a scene is an object, such as {\"effects\": "
                         "{\"motion\": true}}.");
    }
    const JsonValue root = parseJson(text, name);
    return FileReader(root, name).read();
}

EffectsFile readEffectsFile(const std::filesystem::path& path) {
    return parseEffectsFile(readText(path), path.string());
}

}  // namespace hashphase::demos
