// SPDX-License-Identifier: Zlib
#include <demos/system/process.hpp>

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include <io.h>
#include <process.h>
#define WIN32_LEAN_AND_MEAN
#include <windows.h>

namespace hashphase::demos {
namespace {

// As the C runtime of the other program takes it apart: quotes, and the backslashes before them, have another
// backslash before them.
std::wstring quoted(const std::wstring& argument) {
    std::wstring text = L"\"";
    std::size_t backslashes = 0;
    for (const wchar_t letter : argument) {
        if (letter == L'"') {
            text.append(backslashes + 1, L'\\');
        }
        backslashes = letter == L'\\' ? backslashes + 1 : 0;
        text += letter;
    }
    return text.append(backslashes, L'\\') + L'"';
}

std::size_t columnsOfConsole(DWORD stream) noexcept {
    CONSOLE_SCREEN_BUFFER_INFO screen{};
    return GetConsoleScreenBufferInfo(GetStdHandle(stream), &screen) != 0
               ? static_cast<std::size_t>(screen.srWindow.Right - screen.srWindow.Left + 1)
               : 0;
}

// Ctrl-C reaches all programs of a console: the one that runs instead decides when both end.
BOOL WINAPI goOn(DWORD /*event*/) {
    return TRUE;
}

}  // namespace

bool errIsTerminal() noexcept {
    return _isatty(2) != 0;
}

std::size_t outColumns() noexcept {
    return columnsOfConsole(STD_OUTPUT_HANDLE);
}

std::size_t errColumns() noexcept {
    return columnsOfConsole(STD_ERROR_HANDLE);
}

std::filesystem::path programBeside(const std::string& name) {
    std::wstring own(32768, L'\0');  // no path is longer
    own.resize(GetModuleFileNameW(nullptr, own.data(), static_cast<DWORD>(own.size())));
    return std::filesystem::path(own).parent_path() / (name + ".exe");
}

// What Windows calls exec() comes back to the shell before the program has ended.
int runInstead(const std::filesystem::path& program, std::vector<std::string> arguments) {
    std::vector<std::wstring> words{quoted(program.wstring())};
    for (const std::string& argument : arguments) {
        words.push_back(quoted(std::filesystem::path(argument).wstring()));
    }
    std::vector<const wchar_t*> pointers;
    for (const std::wstring& word : words) {
        pointers.push_back(word.c_str());
    }
    pointers.push_back(nullptr);
    SetConsoleCtrlHandler(&goOn, TRUE);
    const std::intptr_t code = _wspawnv(_P_WAIT, program.c_str(), pointers.data());
    if (code == -1) {
        throw std::system_error(errno, std::generic_category());
    }
    return static_cast<int>(code);
}

void setEnvironment(const char* name, const char* value) noexcept {
    static_cast<void>(SetEnvironmentVariableA(name, value));
}

void pinToThisCore() noexcept {
    SetThreadAffinityMask(GetCurrentThread(), DWORD_PTR{1} << GetCurrentProcessorNumber() % 64);
}

std::string processorName() {
    const char* name = std::getenv("PROCESSOR_IDENTIFIER");
    return name != nullptr ? name : "unknown";
}

std::string operatingSystem() {
    return "Windows";
}

}  // namespace hashphase::demos
