#ifdef _WIN32

#include "photos/child_process.h"

#include <windows.h>

#include <chrono>
#include <map>

#include "error.h"
#include "file_bytes.h"

namespace treerec {

namespace {

constexpr DWORD kListenMs = 50;

class Handle {
  public:
    Handle() = default;
    explicit Handle(HANDLE handle) : handle_(handle) {}
    ~Handle() { reset(); }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;

    void reset(HANDLE handle = nullptr) {
        if (handle_ && handle_ != INVALID_HANDLE_VALUE) CloseHandle(handle_);
        handle_ = handle;
    }
    HANDLE get() const { return handle_; }

  private:
    HANDLE handle_ = nullptr;
};

std::wstring wide(const std::string& utf8) {
    return path_of(utf8).wstring();
}

// As every program of Microsoft's C library takes its command line apart again.
std::wstring quoted(const std::wstring& word) {
    if (!word.empty() && word.find_first_of(L" \t\n\v\"") == std::wstring::npos) return word;
    std::wstring out = L"\"";
    size_t slashes = 0;
    for (const wchar_t c : word) {
        if (c == L'\\') {
            slashes++;
            continue;
        }
        out.append(c == L'"' ? 2 * slashes + 1 : slashes, L'\\');
        slashes = 0;
        out += c;
    }
    out.append(2 * slashes, L'\\');
    return out + L"\"";
}

struct IgnoreCase {
    bool operator()(const std::wstring& a, const std::wstring& b) const {
        return CompareStringOrdinal(a.c_str(), -1, b.c_str(), -1, TRUE) == CSTR_LESS_THAN;
    }
};

// Ours, with what the command adds: "NAME=value" with a null after each, sorted as Windows wants it.
std::wstring environment_of(const ChildCommand& command) {
    std::map<std::wstring, std::wstring, IgnoreCase> values;
    wchar_t* const ours = GetEnvironmentStringsW();
    for (const wchar_t* at = ours; at && *at; at += wcslen(at) + 1) {
        const std::wstring word = at;
        // Those that begin with '=' are the drives' current folders.
        const size_t equals = word.find(L'=', 1);
        if (equals != std::wstring::npos) values[word.substr(0, equals)] = word.substr(equals + 1);
    }
    if (ours) FreeEnvironmentStringsW(ours);
    for (const auto& [name, value] : command.environment)
        values[wide(name)] = wide(value);
    std::wstring block;
    for (const auto& [name, value] : values)
        block += name + L"=" + value + L'\0';
    return block + L'\0';
}

Error failed_to_start(const ChildCommand& command) {
    return Error("'" + command.program + "' could not be started (Windows' error " +
                 std::to_string(GetLastError()) + ").");
}

// What is in it ends with its last handle, which is ours: with us, however we end.
void make_job(Handle& job) {
    job.reset(CreateJobObjectW(nullptr, nullptr));
    JOBOBJECT_EXTENDED_LIMIT_INFORMATION limits{};
    limits.BasicLimitInformation.LimitFlags = JOB_OBJECT_LIMIT_KILL_ON_JOB_CLOSE;
    SetInformationJobObject(job.get(), JobObjectExtendedLimitInformation, &limits, sizeof limits);
}

}  // namespace

ChildEnd run_child(const ChildCommand& command, const std::function<void(const std::string& line)>& on_line,
                   const Progress* progress) {
    SECURITY_ATTRIBUTES inherited{sizeof inherited, nullptr, TRUE};
    HANDLE ends[2];
    if (!CreatePipe(&ends[0], &ends[1], &inherited, 0)) throw failed_to_start(command);
    Handle output(ends[0]), input(ends[1]);
    SetHandleInformation(output.get(), HANDLE_FLAG_INHERIT, 0);
    const Handle nothing(CreateFileW(L"NUL", GENERIC_READ, FILE_SHARE_READ | FILE_SHARE_WRITE, &inherited,
                                     OPEN_EXISTING, 0, nullptr));
    Handle job;
    make_job(job);

    std::wstring line = quoted(wide(command.program));
    for (const std::string& word : command.arguments)
        line += L" " + quoted(wide(word));
    std::wstring environment = environment_of(command);
    STARTUPINFOW how{};
    how.cb = sizeof how;
    how.dwFlags = STARTF_USESTDHANDLES;
    how.hStdInput = nothing.get();
    how.hStdOutput = input.get();
    how.hStdError = input.get();
    PROCESS_INFORMATION started{};
    if (!CreateProcessW(wide(command.program).c_str(), line.data(), nullptr, nullptr, TRUE,
                        CREATE_SUSPENDED | CREATE_NO_WINDOW | CREATE_UNICODE_ENVIRONMENT, environment.data(),
                        nullptr, &how, &started))
        throw failed_to_start(command);
    const Handle process(started.hProcess), thread(started.hThread);
    if (!AssignProcessToJobObject(job.get(), process.get())) {
        const Error failure = failed_to_start(command);
        TerminateProcess(process.get(), 1);
        throw failure;
    }
    ResumeThread(thread.get());
    input.reset();

    LineCutter lines(on_line);
    const auto start = std::chrono::steady_clock::now();
    ChildEnd end;
    for (;;) {
        if (progress) progress->check();
        const std::chrono::duration<double> since = std::chrono::steady_clock::now() - start;
        if (!end.overdue && command.most_seconds > 0.0 && since.count() > command.most_seconds) {
            end.overdue = true;
            TerminateJobObject(job.get(), 1);
        }
        // Asked before the last look at its output, so that nothing is missed.
        const bool over = WaitForSingleObject(process.get(), 0) == WAIT_OBJECT_0;
        DWORD waiting = 0;
        const bool open = PeekNamedPipe(output.get(), nullptr, 0, nullptr, &waiting, nullptr) != 0;
        if (open && waiting > 0) {
            char bytes[4096];
            DWORD got = 0;
            if (ReadFile(output.get(), bytes, sizeof bytes, &got, nullptr)) lines.take(bytes, got);
            continue;
        }
        if (over) break;
        WaitForSingleObject(process.get(), kListenMs);
    }
    lines.flush();
    DWORD code = 0;
    GetExitCodeProcess(process.get(), &code);
    end.code = static_cast<int>(code);
    return end;
}

}  // namespace treerec

#endif
