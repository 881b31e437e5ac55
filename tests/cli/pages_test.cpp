// SPDX-License-Identifier: Apache-2.0
// Manual pages and completions, checked by the programs that read them.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "cli/lamina_run.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

std::string shell(const std::string& command) {
    const ProgramResult result = run_program({"bash", "-c", command});
    EXPECT_EQ(result.exit_code, 0) << command << "\n" << result.err;
    EXPECT_EQ(result.err, "") << command;
    return result.out;
}

const std::string program = std::string("'") + LAMINA_BINARY + "'";

// Returns the verbs that --help lists: lines of two spaces and a word.
std::vector<std::string> verbs() {
    std::istringstream lines(lamina_run({"--help"}).out);
    std::vector<std::string> names;
    bool listed = false;
    for (std::string line; std::getline(lines, line);) {
        if (line == "Subcommands:") {
            listed = true;
        } else if (listed && line.starts_with("  ")) {
            names.push_back(line.substr(2, line.find(' ', 2) - 2));
        }
    }
    EXPECT_GE(names.size(), 14u);
    return names;
}

// Expects every option of --help ("-o,--output FILE") on the page.
void expect_options_of_help(const std::string& help, const std::string& page) {
    std::istringstream words(help);
    int found = 0;
    for (std::string word; words >> word;) {
        if (!word.starts_with("-h,--") && !word.starts_with("--")) continue;
        const std::string name =
            word.substr(word.find("--"), word.find_first_of("{=,;", 4) - word.find("--"));
        if (name.size() < 4) continue;
        ++found;
        EXPECT_NE(page.find(name), std::string::npos) << name;
    }
    EXPECT_GT(found, 1);
}

TEST(Pages, AreCleanForGroffAndHaveEveryOption) {
    std::vector<std::string> names = verbs();
    names.push_back("");
    for (const std::string& verb : names) {
        const std::string page =
            shell(program + " man " + verb + " | groff -man -ww -Tascii -P-cbou -rLL=200n");
        EXPECT_NE(page.find(verb.empty() ? "lamina - " : "lamina-" + verb + " - "),
                  std::string::npos)
            << verb;
        const ProgramResult help =
            lamina_run(verb.empty() ? std::vector<std::string>{"--help"}
                                    : std::vector<std::string>{verb, "--help"});
        expect_options_of_help(help.out, page);
    }
    EXPECT_EQ(lamina_run({"man", "paint"}).exit_code, 2);
}

TEST(Pages, BashCompletes) {
    const TemporaryFolder folder;
    write_bytes_to(folder / "head.nrrd", "");
    const auto completed = [&](const std::string& words, int at) {
        return shell("cd '" + folder.path().string() + "'; source <(" + program +
                     " completion bash); compopt() { :; }; COMP_WORDS=(" + words +
                     "); COMP_CWORD=" + std::to_string(at) + "; _lamina; echo \"${COMPREPLY[*]}\"");
    };
    EXPECT_EQ(completed("lamina re", 1), "render reproduce\n");
    EXPECT_EQ(completed("lamina render --co", 2), "--colormap --context\n");
    EXPECT_EQ(completed("lamina render --method ''", 3), "slice project trace\n");
    EXPECT_EQ(completed("lamina completion z", 2), "zsh\n");
    EXPECT_EQ(completed("lamina render h", 2), "head.nrrd\n");
    EXPECT_EQ(lamina_run({"completion", "csh"}).exit_code, 2);
}

TEST(Pages, ZshReadsItsScript) {
    shell("zsh -n <(" + program + " completion zsh)");
    // Prints the words that the script offers for a verb, one in each line, without zsh's compsys.
    EXPECT_EQ(shell("zsh -fc '_describe() { print -rl -- ${(P)2}; }; CURRENT=2; words=(lamina re); "
                    "source <(" +
                    program + " completion zsh)' | wc -l"),
              std::to_string(verbs().size()) + "\n");
}

TEST(Pages, FishCompletes) {
    const auto completed = [&](const std::string& line) {
        return shell("HOME=/nonexistent fish --no-config -c '" + program +
                     " completion fish | source; complete -C \"" + line + "\"' | cut -f1 | sort");
    };
    EXPECT_EQ(completed("lamina re"), "render\nreproduce\n");
    EXPECT_EQ(completed("lamina render --co"), "--colormap\n--context\n");
    EXPECT_EQ(completed("lamina render --method "), "project\nslice\ntrace\n");
}

}  // namespace
}  // namespace lamina
