// A folder of temporary files.
#ifndef LD_FOREIGN_FOLDER_H
#define LD_FOREIGN_FOLDER_H

// Removes it with all that is in it; links are removed, not followed.
void foreign_folder_remove(const char *folder);

#endif
