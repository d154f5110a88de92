#include "cli/describe_parameter.h"

#include <cstdio>

#include "edit/commands/command_text.h"

namespace treerec {

std::string describe_parameter(const Parameter& parameter) {
    std::string text = parameter.name + "=";
    switch (parameter.type) {
        case ParameterType::kNumber:
        case ParameterType::kLength:
        case ParameterType::kWhole:
            text += parameter.standard.empty() ? "N" : parameter.standard;
            text += " (" + number_text(parameter.least) + " to " + number_text(parameter.most) + ")";
            break;
        case ParameterType::kWord:
            for (size_t i = 0; i < parameter.words.size(); i++)
                text += (i ? "|" : "") + parameter.words[i];
            break;
        case ParameterType::kSwitch:
            text += parameter.standard == "yes" ? "yes|no" : "no|yes";
            break;
        case ParameterType::kText:
            text += "TEXT";
            break;
        case ParameterType::kNode:
            text += "NODE";
            break;
        case ParameterType::kNodes:
            text += parameter.standard.empty() ? "NODES" : parameter.standard;
            break;
        case ParameterType::kPoint:
        case ParameterType::kOffset:
        case ParameterType::kDirection:
            text += parameter.standard.empty() ? "X,Y,Z" : parameter.standard;
            break;
    }
    return (parameter.required ? text : "[" + text + "]") + "  " + parameter.help;
}

void print_command(const std::string& name, const std::string& summary,
                   const std::vector<Parameter>& parameters) {
    std::printf("%s  %s\n", name.c_str(), summary.c_str());
    for (const Parameter& parameter : parameters)
        std::printf("    %s\n", describe_parameter(parameter).c_str());
}

}  // namespace treerec
