// The program that web_throws.cpp is a module of; as the engine, it is built without exceptions.
#include <dlfcn.h>

#include <cstdio>

int main(int, char** arguments) {
    void* const module = dlopen(arguments[1], RTLD_NOW);
    if (!module) {
        std::printf("not loaded: %s\n", dlerror());
        return 1;
    }
    const auto throws = reinterpret_cast<int (*)(int)>(dlsym(module, "web_throws"));
    if (!throws || throws(0) != 0 || throws(1) != 't') return 1;
    std::printf("caught\n");
    return 0;
}
