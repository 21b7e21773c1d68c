// Calls what other objects define: main() of glm.cpp by other names. With libraries as arguments, `library function`
// each, it loads them first, so that each takes from those before it what they have too.

#include <cstdio>

#ifdef LOADED
#include <dlfcn.h>

int main(int count, char** arguments) {
    void* libraries[2] = {};
    for (int i = 0; 2 * i + 2 < count; ++i) {
        libraries[i] = dlopen(arguments[2 * i + 1], RTLD_NOW | RTLD_GLOBAL);
        if (libraries[i] == nullptr) return std::puts(dlerror()), 1;
    }
    for (int i = 0; 2 * i + 2 < count; ++i)
        if (reinterpret_cast<int (*)()>(dlsym(libraries[i], arguments[2 * i + 2]))() != 0) return 1;
}
#else
int results_of_one();
int results_of_two();

int main() { return results_of_one() + results_of_two(); }
#endif
