#pragma once

#include <godot_cpp/variant/variant.hpp>

#include <cstdint>

namespace godot {

// Both print to the console and, in the editor, to the Output and Debugger panels. `p_condition` may be
// empty.
void _err_print(const char* p_function, const char* p_file, int p_line, const char* p_condition,
                const String& p_message = String(), bool p_is_warning = false);
void _err_print_index(const char* p_function, const char* p_file, int p_line, int64_t p_index, int64_t p_size,
                      const char* p_index_text, const char* p_size_text, const String& p_message = String());

}  // namespace godot

#define _GODOT_HERE __func__, __FILE__, __LINE__
// `m_leave` is a statement (return, return value, continue, break), so no do-while; the else takes the
// semicolon.
#define _GODOT_LEAVE_IF(m_condition, m_text, m_message, m_leave) \
    if (m_condition) [[unlikely]] {                              \
        ::godot::_err_print(_GODOT_HERE, m_text, m_message);     \
        m_leave;                                                 \
    } else                                                       \
        ((void)0)
#define _GODOT_LEAVE_IF_INDEX(m_index, m_size, m_message, m_leave)                                   \
    if (int64_t(m_index) < 0 || int64_t(m_index) >= int64_t(m_size)) [[unlikely]] {                  \
        ::godot::_err_print_index(_GODOT_HERE, int64_t(m_index), int64_t(m_size), #m_index, #m_size, \
                                  m_message);                                                        \
        m_leave;                                                                                     \
    } else                                                                                           \
        ((void)0)

#define ERR_FAIL_COND_MSG(m_cond, m_msg) \
    _GODOT_LEAVE_IF(m_cond, "Condition \"" #m_cond "\" is true.", m_msg, return )
#define ERR_FAIL_COND(m_cond) ERR_FAIL_COND_MSG(m_cond, ::godot::String())
#define ERR_FAIL_COND_V_MSG(m_cond, m_ret, m_msg) \
    _GODOT_LEAVE_IF(m_cond, "Condition \"" #m_cond "\" is true. Returning: " #m_ret, m_msg, return m_ret)
#define ERR_FAIL_COND_V(m_cond, m_ret) ERR_FAIL_COND_V_MSG(m_cond, m_ret, ::godot::String())
#define ERR_FAIL_NULL_MSG(m_param, m_msg) \
    _GODOT_LEAVE_IF((m_param) == nullptr, "Parameter \"" #m_param "\" is null.", m_msg, return )
#define ERR_FAIL_NULL(m_param) ERR_FAIL_NULL_MSG(m_param, ::godot::String())
#define ERR_FAIL_NULL_V_MSG(m_param, m_ret, m_msg) \
    _GODOT_LEAVE_IF((m_param) == nullptr, "Parameter \"" #m_param "\" is null.", m_msg, return m_ret)
#define ERR_FAIL_NULL_V(m_param, m_ret) ERR_FAIL_NULL_V_MSG(m_param, m_ret, ::godot::String())
#define ERR_FAIL_INDEX_MSG(m_index, m_size, m_msg) _GODOT_LEAVE_IF_INDEX(m_index, m_size, m_msg, return )
#define ERR_FAIL_INDEX(m_index, m_size) ERR_FAIL_INDEX_MSG(m_index, m_size, ::godot::String())
#define ERR_FAIL_INDEX_V_MSG(m_index, m_size, m_ret, m_msg) \
    _GODOT_LEAVE_IF_INDEX(m_index, m_size, m_msg, return m_ret)
#define ERR_FAIL_INDEX_V(m_index, m_size, m_ret) \
    ERR_FAIL_INDEX_V_MSG(m_index, m_size, m_ret, ::godot::String())
#define ERR_FAIL_MSG(m_msg) _GODOT_LEAVE_IF(true, "Method/function failed.", m_msg, return )
#define ERR_FAIL() ERR_FAIL_MSG(::godot::String())
#define ERR_FAIL_V_MSG(m_ret, m_msg) \
    _GODOT_LEAVE_IF(true, "Method/function failed. Returning: " #m_ret, m_msg, return m_ret)
#define ERR_FAIL_V(m_ret) ERR_FAIL_V_MSG(m_ret, ::godot::String())
#define ERR_CONTINUE_MSG(m_cond, m_msg) \
    _GODOT_LEAVE_IF(m_cond, "Condition \"" #m_cond "\" is true. Continuing.", m_msg, continue)
#define ERR_CONTINUE(m_cond) ERR_CONTINUE_MSG(m_cond, ::godot::String())
#define ERR_BREAK_MSG(m_cond, m_msg) \
    _GODOT_LEAVE_IF(m_cond, "Condition \"" #m_cond "\" is true. Breaking.", m_msg, break)
#define ERR_BREAK(m_cond) ERR_BREAK_MSG(m_cond, ::godot::String())
#define ERR_PRINT(m_msg) ::godot::_err_print(_GODOT_HERE, "", m_msg)
#define WARN_PRINT(m_msg) ::godot::_err_print(_GODOT_HERE, "", m_msg, true)
