#pragma once

#include <vector>

#include "bench/commands/command_set.hpp"

namespace mpm {

/// Adds a command to the program. A new command is a file commands/NAME.cpp and a line here, and a
/// place in one of the tasks below.
using AddCommand = void(CommandSet& commands);

AddCommand add_init;         // writes a study of your own plant
AddCommand add_init_method;  // writes a method of your own, with one function to fill in
AddCommand add_methods;      // the methods of assessment; the input and the answers of one of them
AddCommand add_run;          // runs a study and writes its archive
AddCommand add_merge;        // makes the archive of parts that were run on several machines
AddCommand add_validate;     // says what is implausible in a study, and what it will show and cost
AddCommand add_identify;     // identifies a model for the controller from a step test on the plant
AddCommand add_replay;       // runs one experiment of an archive again
AddCommand add_summary;      // what a study found, as text or JSON
AddCommand add_suite;        // plants and families of experiments, and the leaderboard of the methods
AddCommand add_sweep;        // runs a study once for each value of its open choices
AddCommand add_check;        // compares an archive or the run of a suite with limits
AddCommand add_check_board;  // checks that the results of a method are complete and a rerun agrees
AddCommand add_report;       // what a study found, as a page and figures
AddCommand add_plot;         // draws the loop of one experiment
AddCommand add_compare;      // compares several methods of assessment on the loops of an archive
AddCommand add_assess;       // records of a plant: what the methods say about them, and how far to trust it
AddCommand add_repair;  // identifies a named channel again, and estimates the gain of the repaired controller
AddCommand add_reproduce;   // the tables of the thesis
AddCommand add_export;      // a table of an archive as CSV
AddCommand add_cache;       // the loops that are kept for the next suite
AddCommand add_list;        // the shipped studies
AddCommand add_show;        // prints the text of a study
AddCommand add_manual;      // the manual page, from the declarations of all commands
AddCommand add_completion;  // the completion of commands and options for bash

/// Commands that serve one task, in the order of the help.
struct Task {
  const char* name;
  std::vector<AddCommand*> commands;
};

inline std::vector<Task> tasks() {
  return {{"Test methods on simulated loops",
           {add_init, add_validate, add_run, add_merge, add_sweep, add_suite, add_check_board, add_compare,
            add_methods, add_init_method}},
          {"Look at the results", {add_summary, add_report, add_plot, add_check, add_export, add_replay}},
          {"Assess the records of a plant", {add_assess, add_identify, add_repair}},
          {"Shipped studies and the program itself",
           {add_list, add_show, add_reproduce, add_cache, add_manual, add_completion}}};
}

}  // namespace mpm
