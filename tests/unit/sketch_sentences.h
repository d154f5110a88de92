// What the readers of sketches say of what is none.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "error.h"
#include "sketch/read_sketch.h"

namespace treerec::test {

template <typename Parse>
std::string sentence_of(const Parse& parse) {
    try {
        parse();
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

inline std::string json_fault(const std::string& text) {
    return sentence_of([&] { parse_sketch_json(text, "'s.json'"); });
}

inline std::string svg_fault(const std::string& text) {
    return sentence_of([&] { parse_sketch_svg(text, "'s.svg'"); });
}

// Holds, and is a sentence with its subject.
inline void expect_says(const std::string& sentence, const std::string& part) {
    EXPECT_NE(sentence.find(part), std::string::npos) << sentence;
    EXPECT_TRUE(sentence.starts_with("'s.")) << sentence;
    EXPECT_TRUE(sentence.ends_with(".")) << sentence;
}

}  // namespace treerec::test
